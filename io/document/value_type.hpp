#pragma once
// Types of values and structs with a field list (core/fields.hpp) as data.  What reads, documents and checks scene files works from these
// descriptions, so that it is compiled once and not once per struct.
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"

namespace talus {

struct StructType;

/// The type of a value.  A void* points to a value of the type that is described.
struct ValueType {
  enum class Kind : std::uint8_t {
    number,        ///< Real
    whole_number,  ///< Index
    boolean,       ///< bool
    text,          ///< std::string
    word,          ///< an enum
    table,         ///< Table
    list,          ///< std::vector or std::array
    optional,      ///< std::optional
    mapping,       ///< a struct with fields()
    choice,        ///< one of several structs: what choices_of() takes
    named,         ///< NamedNumbers: a mapping of numbers
  };
  Kind kind;
  std::span<const std::string_view> words{};     ///< word: all of them, in the order of the enumerators
  std::span<const StructType* const> structs{};  ///< mapping: the struct; choice: all of them, in the order of the variant
  const ValueType* entry = nullptr;              ///< list, optional: the type of the entries
  std::size_t length = 0;                        ///< list: entries of a std::array; 0 for a std::vector

  std::size_t (*size)(const void* value) = nullptr;               ///< list, optional: number of entries
  void (*resize)(void* value, std::size_t size) = nullptr;        ///< list, optional: so many entries, all with their defaults
  std::size_t (*chosen)(const void* value) = nullptr;             ///< word: its number
  void (*choose)(void* value, std::size_t which) = nullptr;       ///< word, choice: that word or struct, with its defaults
  const void* (*at)(const void* value, std::size_t i) = nullptr;  ///< list, optional: entry i; choice: the chosen struct (i = 0)

  void* edit_at(void* value, std::size_t i) const { return const_cast<void*>(at(value, i)); }
};

/// A row of a field list.
struct FieldType {
  std::string_view key, unit, meaning;  ///< without a unit "-"; empty for structs, lists of structs and texts
  Need need;
  Range range;
  bool is_alternative = false;  ///< the key names one of several structs, whose fields stand in the same mapping
  const ValueType* type = nullptr;
  std::ptrdiff_t offset = 0;  ///< of the member in the struct [bytes]

  /// Whether an empty list is as none: of structs that need not be given, such as `loads: []`.
  bool may_be_empty() const noexcept
  {
    return need == Need::optional && type->kind == ValueType::Kind::list && type->length == 0 &&
           (type->entry->kind == ValueType::Kind::mapping || type->entry->kind == ValueType::Kind::choice);
  }

  void* member_of(void* object) const noexcept { return static_cast<std::byte*>(object) + offset; }
  const void* member_of(const void* object) const noexcept { return static_cast<const std::byte*>(object) + offset; }
};

/// A struct with a field list.
struct StructType {
  std::string_view name, summary;  ///< empty unless the struct has them
  std::vector<FieldType> fields{};
  const void* defaults = nullptr;                                                   ///< a default-constructed struct
  void (*set_where)(void* object, SourceLocation where) = nullptr;                  ///< nullptr unless it has `where`
  void (*check)(const void* object, std::vector<std::string>& problems) = nullptr;  ///< nullptr unless it has check()
};

/// The description of a type, made once.  The address identifies the type.  It is compiled in one source: value_type.cpp for what every
/// document uses, io/scene/scene_types.cpp for the structs of scenes.  Elsewhere an asked type that these do not name is not linked.
template <class T>
const ValueType& value_type();
/// The description of a struct with fields().
template <class T>
const StructType& struct_type();

/// The value of a known type behind a pointer.
template <class T>
const T& as(const void* value) noexcept
{
  return *static_cast<const T*>(value);
}
template <class T>
T& as(void* value) noexcept
{
  return *static_cast<T*>(value);
}

/// A default as the manual shows it.  A number out of its range, an empty text and an empty list mean "not given": "none".
std::string default_text(const ValueType& type, const void* value, const Range& range);

}  // namespace talus
