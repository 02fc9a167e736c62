#pragma once
// Fills structs from a document by their field lists: one implementation for all blocks, laws and shapes.
#include <concepts>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "core/fields.hpp"
#include "core/time_table.hpp"
#include "io/document/document.hpp"
#include "io/document/scalars.hpp"

namespace talus {

template <class T>
concept HasCheck = requires(const T& object, std::vector<std::string>& problems)
{
  object.check(problems);
};
template <class T>
concept HasWhere = requires(T& object)
{
  object.where = SourceLocation{};
};

/// One mapping while it is read.  A key that is not in the field list is an error.  Rules between keys are checked at the end, and only if
/// the keys themselves are correct, so that one mistake gives one message.
class Mapping {
 public:
  Mapping(const Node& node, std::string path, Problems& problems)
      : node_(node), path_(std::move(path)), problems_(problems), before_(problems.size())
  {}

  SourceLocation where() const { return to_where(node_.place, path_); }
  /// The path of a key, with the name that is used in the file.
  std::string path_of(std::string_view key) const { return path_to(path_, node_.word_for(key)); }
  void complain(std::string message) { problems_.add(node_.place, path_, std::move(message)); }

  /// The value of a key, or nullptr; the key counts as known from now on.
  const Node* find(std::string_view key);
  /// The value of a key; a missing key is recorded as an error.
  const Node* find_required(std::string_view key, std::string_view unit);
  /// Disables the check for unknown keys, because the key that determines the valid ones is wrong.
  void accept_any_key() { any_key_ = true; }
  void check_later(std::function<void(std::vector<std::string>&)> check) { checks_.push_back(std::move(check)); }
  void close();

 private:
  const Node& node_;
  std::string path_;
  Problems& problems_;
  std::size_t before_;
  bool any_key_ = false;
  std::vector<std::string> known_;
  std::vector<std::function<void(std::vector<std::string>&)>> checks_;
};

/// Reads values by their type.  Nothing is thrown: errors are collected, and a wrong value keeps its default.
class FieldReader {
 public:
  explicit FieldReader(Problems& problems) : problems_(problems) {}

  /// Reads a mapping: every field of T::fields(), then T::check if it exists.
  template <HasFields T>
  void read(const Node& node, const std::string& path, const Asked&, T& object)
  {
    if (!is(Node::Kind::mapping, node, path, "a mapping {key: value}"))
      return;
    Mapping mapping(node, path, problems_);
    read_fields(mapping, object);
    mapping.close();
  }

  /// Reads a mapping whose key `type` chooses the struct.
  template <HasFields... T>
  void read(const Node& node, const std::string& path, const Asked&, std::variant<T...>& object)
  {
    if (!is(Node::Kind::mapping, node, path, "a mapping {key: value}"))
      return;
    Mapping mapping(node, path, problems_);
    read_alternative(mapping, "type", object);
    mapping.close();
  }

  template <class T>
  void read(const Node& node, const std::string& path, const Asked& asked, std::optional<T>& object)
  {
    read(node, path, asked, object.emplace());
  }

  template <class T>
  void read(const Node& node, const std::string& path, const Asked& asked, std::vector<T>& list)
  {
    if (!is(Node::Kind::list, node, path, "a list [..., ...]"))
      return;
    list.assign(node.items.size(), T{});
    if (list.empty())
      problems_.add(node.place, path, "the list is empty");
    for (std::size_t i = 0; i < list.size(); ++i)
      read(node.items[i], path_to(path, i, node.items[i]), asked, list[i]);
  }

  template <class T, std::size_t N>
  void read(const Node& node, const std::string& path, const Asked& asked, std::array<T, N>& list)
  {
    if (!is(Node::Kind::list, node, path, "a list [..., ...]"))
      return;
    if (node.items.size() != N)
      return problems_.add(node.place, path, count_message(N, node.items.size()));
    for (std::size_t i = 0; i < N; ++i)
      read(node.items[i], path_to(path, i, node.items[i]), asked, list[i]);
  }

  void read(const Node& node, const std::string& path, const Asked& asked, Table& table);

  /// Copies the value, whatever it is.
  void read(const Node& node, const std::string& path, const Asked& asked, Node& value);

  /// Reads a number, integer, bool, text or word of an enum.
  template <class T>
  requires requires(const Node& node, T& value) { read_scalar(node, Asked{}, value); }
  void read(const Node& node, const std::string& path, const Asked& asked, T& value)
  {
    if (!is(Node::Kind::scalar, node, path, scalar_name(value)))
      return;
    if (auto complaint = read_scalar(node, asked, value))
      problems_.add(node.place, path, std::move(*complaint));
  }

 private:
  template <HasFields T>
  void read_fields(Mapping& mapping, T& object)
  {
    if constexpr (HasWhere<T>)
      object.where = mapping.where();
    for_each_field<T>([&](const auto& field) { read_field(mapping, field, object); });
    if constexpr (HasCheck<T>)
      mapping.check_later([&object](std::vector<std::string>& problems) { object.check(problems); });
  }

  /// The struct that declares a field, which may be a base of the law.
  template <class T, class Value>
  void read_field(Mapping& mapping, const Parameter<T, Value>& field, std::type_identity_t<T>& object)
  {
    read_key(mapping, field.key, field.need, {field.range, field.unit}, object.*field.member);
  }
  template <class T, class Value>
  void read_field(Mapping& mapping, const Choice<T, Value>& field, std::type_identity_t<T>& object)
  {
    read_key(mapping, field.key, field.need, {}, object.*field.member);
  }
  template <class T, class Value>
  void read_field(Mapping& mapping, const Group<T, Value>& field, std::type_identity_t<T>& object)
  {
    read_key(mapping, field.key, Need::required, {}, object.*field.member);
  }
  template <class T, class Value>
  void read_field(Mapping& mapping, const Group<T, std::optional<Value>>& field, std::type_identity_t<T>& object)
  {
    read_key(mapping, field.key, Need::optional, {}, object.*field.member);
  }
  template <class T, class Item>
  void read_field(Mapping& mapping, const List<T, Item>& field, std::type_identity_t<T>& object)
  {
    read_key(mapping, field.key, field.need, {}, object.*field.member);
  }
  template <class T, class Value>
  void read_field(Mapping& mapping, const Alternative<T, Value>& field, std::type_identity_t<T>& object)
  {
    read_alternative(mapping, field.key, choices_of(object.*field.member));
  }

  template <class Value>
  void read_key(Mapping& mapping, std::string_view key, Need need, const Asked& asked, Value& value)
  {
    const Node* node = need == Need::required ? mapping.find_required(key, asked.unit) : mapping.find(key);
    if (node != nullptr)
      read(*node, mapping.path_of(key), asked, value);
  }

  /// Reads the struct that `key` names, and its fields from the same mapping.
  template <HasFields... T>
  void read_alternative(Mapping& mapping, std::string_view key, std::variant<T...>& object)
  {
    std::string chosen;
    read_key(mapping, key, Need::required, {}, chosen);
    const auto read_as = [&]<class Chosen>(std::type_identity<Chosen>) {
      if (chosen != Chosen::name)
        return false;
      read_fields(mapping, object.template emplace<Chosen>());
      return true;
    };
    if ((read_as(std::type_identity<T>{}) || ...))
      return;
    mapping.accept_any_key();
    if (!chosen.empty())
      problems_.add(mapping.find(key)->place, mapping.path_of(key), unknown_word(key, chosen, {std::string(T::name)...}));
  }

  /// Whether the value is of that kind; otherwise records an error, unless there is one already.
  bool is(Node::Kind kind, const Node& node, const std::string& path, std::string_view expected);
  static std::string count_message(std::size_t wanted, std::size_t found);
  static std::string unknown_word(std::string_view key, const std::string& word, const std::vector<std::string>& known);

  Problems& problems_;
};

}  // namespace talus
