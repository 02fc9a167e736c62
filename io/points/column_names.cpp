#include "io/points/column_names.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace talus {

namespace {

using Names = std::span<const std::string_view>;
constexpr std::array<std::string_view, 9> stress_names{"stress",      "sigma",       "sig", "s", "ss", "cauchystress", "cauchystresstensor",
                                                       "totalstress", "stresstensor"};
constexpr std::array<std::string_view, 8> effective_names{"effectivestress", "effstress", "stresseffective", "stresseff", "sigma'",
                                                          "sigmaeff",        "s'",        "sigmaeffective"};
constexpr std::array<std::string_view, 4> shear_names{"tau", "sigma", "sig", "stress"};  // of tau_xy and sigma_x
constexpr std::array<std::string_view, 4> pore_names{"porepressure", "porewaterpressure", "waterpressure", "por"};
constexpr std::array<std::string_view, 4> velocity_names{"velocity", "vel", "v", "vv"};
constexpr std::array<std::string_view, 5> displacement_names{"displacement", "displ", "disp", "u", "uu"};
constexpr std::array<std::string_view, 8> position_names{"",      "position", "coordinate", "coordinates",
                                                         "coord", "coords",   "coor",       "coordcoor"};

using Component = std::pair<std::string_view, std::size_t>;
constexpr std::array<Component, 18> tensor_components{{{"xx", 0},
                                                       {"yy", 1},
                                                       {"zz", 2},
                                                       {"xy", 3},
                                                       {"yx", 3},
                                                       {"yz", 4},
                                                       {"zy", 4},
                                                       {"xz", 5},
                                                       {"zx", 5},
                                                       {"11", 0},
                                                       {"22", 1},
                                                       {"33", 2},
                                                       {"12", 3},
                                                       {"21", 3},
                                                       {"23", 4},
                                                       {"32", 4},
                                                       {"13", 5},
                                                       {"31", 5}}};
constexpr std::array<Component, 6> numbered_components{{{"0", 0}, {"1", 1}, {"2", 2}, {"3", 3}, {"4", 4}, {"5", 5}}};  // of ParaView
constexpr std::array<Component, 3> axis_components{{{"x", 0}, {"y", 1}, {"z", 2}}};
constexpr std::array<Component, 3> from_zero{{{"0", 0}, {"1", 1}, {"2", 2}}};  // of ParaView
constexpr std::array<Component, 3> from_one{{{"1", 0}, {"2", 1}, {"3", 2}}};   // of Abaqus

/// The component if the name is one of `names` and one of the endings.
std::optional<std::size_t> component_named(std::string_view name, Names names, std::span<const Component> endings)
{
  for (const std::string_view base : names)
    for (const auto& [ending, component] : endings)
      if (name.size() == base.size() + ending.size() && name.starts_with(base) && name.ends_with(ending))
        return component;
  return std::nullopt;
}

}  // namespace

std::string plain_name(std::string_view name)
{
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 5> written_out{
      {{"\u03c3", "sigma"}, {"\u03c4", "tau"}, {"\u2032", "'"}, {"\u2019", "'"}, {"\u03a3", "sigma"}}};
  std::string plain;
  while (!name.empty()) {
    const auto* const found = std::ranges::find_if(written_out, [&](const auto& one) { return name.starts_with(one.first); });
    if (found != written_out.end()) {
      plain += found->second;
      name.remove_prefix(found->first.size());
      continue;
    }
    const char c = name.front();
    if (c >= 'A' && c <= 'Z')
      plain += static_cast<char>(c - 'A' + 'a');
    else if (std::string_view(" _-.:,()[]{}/").find(c) == std::string_view::npos)
      plain += c;
    name.remove_prefix(1);
  }
  return plain;
}

ColumnMeaning meaning_of(std::string_view name)
{
  const std::string plain = plain_name(name);
  const bool numbered = name.ends_with(":0") || name.ends_with(":1") || name.ends_with(":2") || name.ends_with(":3") ||
                        name.ends_with(":4") || name.ends_with(":5");
  if (const auto c = component_named(plain, effective_names, tensor_components))
    return {PointQuantity::effective_stress, *c};
  if (const auto c = component_named(plain, stress_names, tensor_components))
    return {PointQuantity::stress, *c};
  if (const auto c = component_named(plain, shear_names, tensor_components))
    return {PointQuantity::stress, *c};
  if (const auto c = component_named(plain, Names(shear_names).subspan(1), axis_components))
    return {PointQuantity::stress, *c};
  if (const auto c = component_named(plain, stress_names, numbered_components); c && numbered)
    return {PointQuantity::stress, *c};
  if (std::ranges::find(pore_names, plain) != pore_names.end())
    return {PointQuantity::pore_pressure, 0};
  static constexpr std::array<std::string_view, 1> points{"points"};
  if (const auto c = component_named(plain, points,
                                     numbered || name.ends_with("_0") || name.ends_with("_1") || name.ends_with("_2")
                                         ? std::span<const Component>(from_zero)
                                         : std::span<const Component>(axis_components)))
    return {PointQuantity::position, *c};
  const auto vector = [&](Names names) -> std::optional<std::size_t> {
    if (const auto c = component_named(plain, names, axis_components))
      return c;
    return component_named(plain, names, numbered ? from_zero : from_one);
  };
  if (const auto c = component_named(plain, position_names, axis_components))
    return {PointQuantity::position, *c};
  if (const auto c = component_named(plain, Names(position_names).subspan(1), from_one))
    return {PointQuantity::position, *c};
  if (const auto c = vector(velocity_names))
    return {PointQuantity::velocity, *c};
  if (const auto c = vector(displacement_names))
    return {PointQuantity::displacement, *c};
  return {};
}

Real factor_of_unit(std::string_view unit, PointQuantity quantity)
{
  using Unit = std::pair<std::string_view, Real>;
  static constexpr std::array<Unit, 13> stresses{{{"Pa", 1},
                                                  {"kPa", 1e3},
                                                  {"MPa", 1e6},
                                                  {"GPa", 1e9},
                                                  {"N/m^2", 1},
                                                  {"N/m2", 1},
                                                  {"N/m\u00b2", 1},
                                                  {"kN/m^2", 1e3},
                                                  {"kN/m2", 1e3},
                                                  {"kN/m\u00b2", 1e3},
                                                  {"MN/m^2", 1e6},
                                                  {"N/mm^2", 1e6},
                                                  {"N/mm2", 1e6}}};
  static constexpr std::array<Unit, 4> lengths{{{"m", 1}, {"km", 1e3}, {"cm", 1e-2}, {"mm", 1e-3}}};
  static constexpr std::array<Unit, 3> speeds{{{"m/s", 1}, {"cm/s", 1e-2}, {"mm/s", 1e-3}}};
  const bool is_length = quantity == PointQuantity::position || quantity == PointQuantity::displacement;
  const std::span<const Unit> units = is_length                             ? std::span<const Unit>(lengths)
                                      : quantity == PointQuantity::velocity ? std::span<const Unit>(speeds)
                                                                            : std::span<const Unit>(stresses);
  const auto found = std::ranges::find(units, unit, &Unit::first);
  return found == units.end() ? 0 : found->second;
}

}  // namespace talus
