#pragma once
// Makes the descriptions of value_type.hpp out of types.  Only for the sources that instantiate them.
#include <array>
#include <concepts>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>

#include "core/named_numbers.hpp"
#include "core/time_table.hpp"
#include "io/document/document.hpp"
#include "io/document/value_type.hpp"

namespace talus {

namespace detail {

template <class T>
inline constexpr bool is_list = false;
template <class T>
inline constexpr bool is_list<std::vector<T>> = true;
template <class T, std::size_t N>
inline constexpr bool is_list<std::array<T, N>> = true;
template <class T>
inline constexpr std::size_t fixed_length = 0;
template <class T, std::size_t N>
inline constexpr std::size_t fixed_length<std::array<T, N>> = N;
template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;

template <class Enum>
ValueType type_of_words()
{
  static constexpr auto words = enum_names(Enum{});
  return {.kind = ValueType::Kind::word,
          .words = words,
          .chosen = [](const void* value) { return static_cast<std::size_t>(as<Enum>(value)); },
          .choose = [](void* value, std::size_t which) { as<Enum>(value) = static_cast<Enum>(which); }};
}

template <class List>
ValueType type_of_list()
{
  ValueType type{.kind = ValueType::Kind::list, .entry = &value_type<typename List::value_type>(), .length = fixed_length<List>};
  type.size = [](const void* list) { return as<List>(list).size(); };
  type.at = [](const void* list, std::size_t i) -> const void* { return &as<List>(list)[i]; };
  if constexpr (fixed_length<List> == 0)
    type.resize = [](void* list, std::size_t size) { as<List>(list) = List(size); };
  return type;
}

template <class Optional>
ValueType type_of_optional()
{
  return {.kind = ValueType::Kind::optional,
          .entry = &value_type<typename Optional::value_type>(),
          .size = [](const void* optional) { return std::size_t{as<Optional>(optional).has_value()}; },
          .resize = [](void* optional, std::size_t) { as<Optional>(optional).emplace(); },
          .at = [](const void* optional, std::size_t) -> const void* { return &*as<Optional>(optional); }};
}

template <class T, class... One>
ValueType type_of_choice(std::type_identity<std::variant<One...>>)
{
  static const std::array<const StructType*, sizeof...(One)> structs{&struct_type<One>()...};
  return {.kind = ValueType::Kind::choice,
          .structs = structs,
          .choose =
              [](void* value, std::size_t which) {
                auto& variant = choices_of(as<T>(value));
                std::size_t i = 0;
                ((i++ == which ? static_cast<void>(variant.template emplace<One>()) : static_cast<void>(0)), ...);
              },
          .at = [](const void* value, std::size_t) -> const void* {
            return std::visit([](const auto& one) -> const void* { return &one; }, choices_of(as<T>(value)));
          }};
}

template <class T>
ValueType type_of_struct()
{
  static const std::array<const StructType*, 1> one{&struct_type<T>()};
  return {.kind = ValueType::Kind::mapping, .structs = one};
}

template <class T>
ValueType make_value_type()
{
  using Kind = ValueType::Kind;
  if constexpr (std::same_as<T, Real>)
    return {.kind = Kind::number};
  else if constexpr (std::same_as<T, Index>)
    return {.kind = Kind::whole_number};
  else if constexpr (std::same_as<T, bool>)
    return {.kind = Kind::boolean};
  else if constexpr (std::same_as<T, std::string>)
    return {.kind = Kind::text};
  else if constexpr (std::same_as<T, Table>)
    return {.kind = Kind::table};
  else if constexpr (std::same_as<T, NamedNumbers>)
    return {.kind = Kind::named};
  else if constexpr (std::is_enum_v<T>)
    return type_of_words<T>();
  else if constexpr (is_list<T>)
    return type_of_list<T>();
  else if constexpr (is_optional<T>)
    return type_of_optional<T>();
  else if constexpr (HasFields<T>)
    return type_of_struct<T>();
  else
    return type_of_choice<T>(std::type_identity<ChoicesOf<T>>{});
}

/// The row of a field, without its type and offset.
template <class Owner, class Value>
FieldType row_of(const Parameter<Owner, Value>& field)
{
  return {field.key, HasFields<Value> ? std::string_view{} : field.unit, field.meaning, field.need, field.range};
}
template <class Owner, class Value>
FieldType row_of(const Alternative<Owner, Value>& field)
{
  return {field.key, "-", field.meaning, Need::required, any, true};
}

/// Adds a row; `member` points into type.defaults.
void add_field(StructType& type, FieldType row, const ValueType& value, const void* member);

template <class T>
StructType make_struct_type()
{
  static const T defaults{};
  StructType type{};
  type.defaults = &defaults;
  if constexpr (requires { requires std::same_as<decltype(&T::name), const std::string_view*>; })
    type.name = T::name;
  if constexpr (requires { T::summary; })
    type.summary = T::summary;
  if constexpr (requires(T & object) { object.where = SourceLocation{}; })
    type.set_where = [](void* object, SourceLocation where) { as<T>(object).where = std::move(where); };
  if constexpr (requires(const T& object, std::vector<std::string>& problems) { object.check(problems); })
    type.check = [](const void* object, std::vector<std::string>& problems) { as<T>(object).check(problems); };
  for_each_field<T>([&](const auto& field) {
    const auto& member = defaults.*field.member;  // which may be declared in a base of T
    add_field(type, row_of(field), value_type<std::remove_cvref_t<decltype(member)>>(), &member);
  });
  return type;
}

}  // namespace detail

template <class T>
const ValueType& value_type()
{
  static const ValueType type = detail::make_value_type<T>();
  return type;
}

template <class T>
const StructType& struct_type()
{
  static const StructType type = detail::make_struct_type<T>();
  return type;
}

}  // namespace talus
