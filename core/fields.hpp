#pragma once
// Descriptions of parameters.  One declaration per parameter serves to parse, check, document, print and store it.  A struct with described
// members has `static constexpr auto fields()`, which returns a std::tuple of the descriptions below.  The default of an optional field is
// the value in a default-constructed struct, so no default is written twice.
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// The values that a number may have, and their text in messages.
struct Range {
  Real low = -std::numeric_limits<Real>::infinity();
  Real high = std::numeric_limits<Real>::infinity();
  bool low_allowed = false, high_allowed = false;
  constexpr bool holds(Real x) const noexcept
  {
    return (low_allowed ? x >= low : x > low) && (high_allowed ? x <= high : x < high);  // false for NaN
  }
};
inline constexpr Range any{};
inline constexpr Range positive{.low = 0};
inline constexpr Range non_negative{.low = 0, .low_allowed = true};
/// The open range (low, high).
constexpr Range between(Real low, Real high) { return {.low = low, .high = high}; }
/// The closed range [low, high].
constexpr Range within(Real low, Real high) { return {.low = low, .high = high, .low_allowed = true, .high_allowed = true}; }
/// The half-open range [low, high).
constexpr Range from_to_below(Real low, Real high) { return {.low = low, .high = high, .low_allowed = true}; }
constexpr Range at_least(Real low) { return {.low = low, .low_allowed = true}; }
/// The range as text, such as "[0, 90)", "> 0" or "any".
std::string to_string(const Range& range);

enum class Need : std::uint8_t { required, optional };

/// A parameter, read by its type: number, integer, bool, text, Table, list of these, struct with fields() (a mapping), std::variant
/// of such structs (a mapping whose key `type` chooses), std::optional of any of them.  A range holds for every number of a list.
/// Units are "-" where there is none.
template <class Owner, class Value>
struct Parameter {
  std::string_view key;
  Value Owner::*member;
  Need need;
  Range range;
  std::string_view unit, meaning;
};

/// One of several structs: the member is a std::variant of structs with fields(), each with `static constexpr std::string_view
/// name`, or a type that holds such a variant and gives it by a function choices_of().  The key chooses which by its name; the fields of
/// the chosen one stand in the same mapping.
template <class Owner, class Value>
struct Alternative {
  std::string_view key;
  Value Owner::*member;
  std::string_view meaning;
};

template <class... T>
std::variant<T...>& choices_of(std::variant<T...>& value) noexcept
{
  return value;
}
template <class... T>
const std::variant<T...>& choices_of(const std::variant<T...>& value) noexcept
{
  return value;
}
template <class Value>
using ChoicesOf = std::remove_cvref_t<decltype(choices_of(std::declval<Value&>()))>;

/// A history variable of a law, written to outputs and checkpoints.  Value is Real or Sym3.
template <class Owner, class Value>
struct History {
  std::string_view key;
  Value Owner::*member;
  std::string_view unit, meaning;
};

/// A part of the state that a checkpoint stores.  Value is a number, bool, enum, text, vector of space, struct with fields(), std::variant
/// of structs, or a std::vector of any of these.
template <class Owner, class Value>
struct Kept {
  std::string_view key;
  Value Owner::*member;
};

template <class Owner, class Value>
constexpr auto required(std::string_view key, Value Owner::*member, Range range, std::string_view unit, std::string_view meaning)
{
  return Parameter<Owner, Value>{key, member, Need::required, range, unit, meaning};
}
template <class Owner, class Value>
constexpr auto optional(std::string_view key, Value Owner::*member, Range range, std::string_view unit, std::string_view meaning)
{
  return Parameter<Owner, Value>{key, member, Need::optional, range, unit, meaning};
}
/// One of a few named words.  `Value` is an enum with `constexpr auto enum_names(Value) -> std::array<std::string_view, N>`, found by
/// argument-dependent lookup, which lists the words in the order of the enumerators.
template <class Owner, class Value>
constexpr auto required_choice(std::string_view key, Value Owner::*member, std::string_view meaning)
{
  return required(key, member, any, "-", meaning);
}
template <class Owner, class Value>
constexpr auto optional_choice(std::string_view key, Value Owner::*member, std::string_view meaning)
{
  return optional(key, member, any, "-", meaning);
}
/// A nested mapping.  Optional when the member is a std::optional, required otherwise.
template <class Owner, class Value>
constexpr auto group(std::string_view key, Value Owner::*member, std::string_view meaning)
{
  constexpr bool is_optional = requires(const Value& value) { value.has_value(); };
  return Parameter<Owner, Value>{key, member, is_optional ? Need::optional : Need::required, any, "", meaning};
}
/// A list of mappings: the member is a std::vector of a struct with fields(), or of a std::variant of such structs, each with
/// `static constexpr std::string_view name`; for variants the key `type` chooses.
template <class Owner, class Item>
constexpr auto required_list(std::string_view key, std::vector<Item> Owner::*member, std::string_view meaning)
{
  return required(key, member, any, "", meaning);
}
template <class Owner, class Item>
constexpr auto optional_list(std::string_view key, std::vector<Item> Owner::*member, std::string_view meaning)
{
  return optional(key, member, any, "", meaning);
}
template <class Owner, class Value>
constexpr auto alternative(std::string_view key, Value Owner::*member, std::string_view meaning)
{
  return Alternative<Owner, Value>{key, member, meaning};
}
template <class Owner, class Value>
constexpr auto history(std::string_view key, Value Owner::*member, std::string_view unit, std::string_view meaning)
{
  return History<Owner, Value>{key, member, unit, meaning};
}

template <class Owner, class Value>
constexpr auto saved(std::string_view key, Value Owner::*member)
{
  return Kept<Owner, Value>{key, member};
}

template <class T>
concept HasFields = requires
{
  T::fields();
};

/// Calls f(field) for every field of T, in order of declaration.
template <class T, class F>
constexpr void for_each_field(F&& f)
{
  std::apply([&](const auto&... field) { (f(field), ...); }, T::fields());
}

}  // namespace talus
