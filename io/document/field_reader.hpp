#pragma once
// Fills structs from a document by their field lists: one implementation for all blocks, laws and shapes.
#include <string>

#include "io/document/document.hpp"
#include "io/document/scalars.hpp"
#include "io/document/value_type.hpp"

namespace talus {

class Mapping;
struct NamedNumbers;
struct Table;

/// Reads values by their type.  Nothing is thrown: errors are collected, and a wrong value keeps its default.  Of a struct every field is
/// read, then its check() is called, if it has one and the fields are correct.
class FieldReader {
 public:
  explicit FieldReader(Problems& problems) : problems_(problems) {}

  template <class T>
  void read(const Node& node, const std::string& path, T& value)
  {
    read(node, path, {}, value_type<T>(), &value);
  }
  /// `value` points to a value of the type.
  void read(const Node& node, const std::string& path, const Asked& asked, const ValueType& type, void* value);

 private:
  template <class T>
  void read_scalar_of(const Node& node, const std::string& path, const Asked& asked, void* value);
  void read_word(const Node& node, const std::string& path, const ValueType& type, void* value);
  void read_list(const Node& node, const std::string& path, const Asked& asked, const ValueType& type, void* list);
  void read_table(const Node& node, const std::string& path, Table& table);
  void read_named(const Node& node, const std::string& path, NamedNumbers& numbers);
  void read_mapping(const Node& node, const std::string& path, const ValueType& type, void* value);
  void read_fields(Mapping& mapping, const StructType& type, void* object);
  void read_choice(Mapping& mapping, std::string_view key, const ValueType& type, void* value);
  void read_key(Mapping& mapping, const FieldType& field, void* value);

  /// Whether the value is of that kind; otherwise records an error, unless there is one already.
  bool is(Node::Kind kind, const Node& node, const std::string& path, std::string_view expected);

  Problems& problems_;
};

}  // namespace talus
