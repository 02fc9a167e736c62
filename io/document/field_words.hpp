#pragma once
// Descriptions of a field for the reference and the schema beyond its field list.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <concepts>
#include <string>
#include <type_traits>
#include <vector>

#include "core/fields.hpp"

namespace talus {

template <class T>
concept IsList = requires(const T& list)
{
  list.begin();
}
&&!std::same_as<T, std::string>;

/// The default of an optional key.  A number out of its range and an empty text mean "not given".
template <class T>
std::string default_of(const T& value, const Range& range)
{
  if constexpr (std::same_as<T, bool>) {
    return value ? "true" : "false";
  } else if constexpr (std::is_arithmetic_v<T>) {
    return range.holds(value) ? fmt::format("{}", value) : "none";
  } else if constexpr (std::same_as<T, std::string>) {
    return value.empty() ? "none" : value;
  } else if constexpr (std::is_enum_v<T>) {
    return std::string(enum_names(value)[static_cast<std::size_t>(value)]);
  } else if constexpr (IsList<T>) {
    std::vector<std::string> items;
    for (const auto& item : value)
      items.push_back(default_of(item, range));
    return items.empty() ? "none" : fmt::format("[{}]", fmt::join(items, ", "));
  } else if constexpr (requires { value.has_value(); }) {
    return value ? default_of(*value, range) : "none";
  } else {
    return HasFields<T> ? "see there" : "none";
  }
}

}  // namespace talus
