#include "core/field_component.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace talus {

std::vector<std::string> component_names(int components)
{
  switch (components) {
    case 3: return {"x", "y", "z"};
    case 6: return {"xx", "yy", "zz", "xy", "yz", "xz"};
    case 9: return {"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"};
    default: return {};
  }
}

Real viewed_value(std::span<const Real> entry) noexcept
{
  const auto square = [](Real a) { return a * a; };
  if (entry.size() == 1)
    return entry[0];
  if (entry.size() == 6)
    return std::sqrt(0.5 * (square(entry[0] - entry[1]) + square(entry[1] - entry[2]) + square(entry[2] - entry[0])) +
                     3 * (square(entry[3]) + square(entry[4]) + square(entry[5])));
  Real sum = 0;
  for (const Real component : entry)
    sum += square(component);
  return std::sqrt(sum);
}

ViewedField ViewedField::of(std::string_view text)
{
  const auto colon = text.find(':');
  if (colon == text.npos)
    return {std::string(text)};
  return {std::string(text.substr(0, colon)), std::string(text.substr(colon + 1))};
}

std::optional<int> ViewedField::component_of(int components) const
{
  if (component.empty())
    return std::nullopt;
  const auto names = component_names(components);
  const auto found = std::find(names.begin(), names.end(), component);
  if (found == names.end())
    throw Error(names.empty() ? fmt::format("field \"{}\" is one number a particle: it has no component \"{}\"", name, component)
                              : fmt::format("field \"{}\" has no component \"{}\"; it has: {}", name, component, fmt::join(names, ", ")));
  return static_cast<int>(found - names.begin());
}

std::string ViewedField::label(int components) const
{
  std::string words = component.empty() ? name : name + ' ' + component;
  std::replace(words.begin(), words.end(), '_', ' ');
  return components == 6 && component.empty() ? words + " (von Mises)" : words;
}

}  // namespace talus
