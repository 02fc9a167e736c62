#include "io/points/column_names.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

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

/// The end of a name and what it stands for.
struct NameEnd {
  std::string_view text;
  std::size_t component;
  bool mirrored = false;
};
constexpr std::array<NameEnd, 18> tensor_ends{{{"xx", 0},
                                               {"yy", 1},
                                               {"zz", 2},
                                               {"xy", 3},
                                               {"yx", 3, true},
                                               {"yz", 4},
                                               {"zy", 4, true},
                                               {"xz", 5},
                                               {"zx", 5, true},
                                               {"11", 0},
                                               {"22", 1},
                                               {"33", 2},
                                               {"12", 3},
                                               {"21", 3, true},
                                               {"23", 4},
                                               {"32", 4, true},
                                               {"13", 5},
                                               {"31", 5, true}}};
constexpr std::array<NameEnd, 3> axis_ends{{{"x", 0}, {"y", 1}, {"z", 2}}};
/// Of a tensor with nine numbers, row by row.
constexpr std::array<NameEnd, 9> numbers_of_nine{
    {{"0", 0}, {"1", 3}, {"2", 5}, {"3", 3, true}, {"4", 1}, {"5", 4}, {"6", 5, true}, {"7", 4, true}, {"8", 2}}};

bool is_name_in(Names names, std::string_view name) { return std::ranges::find(names, name) != names.end(); }

/// What the name stands for if it is one of `names` and one of the ends.
const NameEnd* end_of(std::string_view name, Names names, std::span<const NameEnd> ends)
{
  for (const std::string_view base : names)
    for (const NameEnd& end : ends)
      if (name.size() == base.size() + end.text.size() && name.starts_with(base) && name.ends_with(end.text))
        return &end;
  return nullptr;
}

/// A name that ends with one digit: "velocity_0", "stress:8", "V1".
struct NumberedName {
  std::string base;  ///< plain
  char separator;    ///< 0 for none
  unsigned digit;
};
std::optional<NumberedName> numbered_name(std::string_view name)
{
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (name.size() < 2 || !is_digit(name.back()))
    return std::nullopt;
  const auto digit = static_cast<unsigned>(name.back() - '0');
  name.remove_suffix(1);
  if (is_digit(name.back()))
    return std::nullopt;
  const bool separated = std::string_view(" _-.:").find(name.back()) != std::string_view::npos;
  return NumberedName{plain_name(name), separated ? name.back() : '\0', digit};
}

/// The digits, one bit each, that follow the same base and separator somewhere in the table.
using DigitsOfNames = std::map<std::pair<std::string, char>, unsigned>;

/// ParaView counts components from zero, Abaqus from one.
std::optional<ColumnMeaning> numbered_meaning(const NumberedName& name, unsigned digits)
{
  const bool by_paraview = name.separator == ':', has_zero = (digits & 1U) != 0;
  const bool is_stress = is_name_in(stress_names, name.base), is_effective = is_name_in(effective_names, name.base);
  if (is_stress || is_effective) {
    constexpr unsigned first_four = 0xFU, first_six = 0x3FU, last_of_nine = 0x1C0U, tenth = 0x200U;
    const auto quantity = is_effective ? PointQuantity::effective_stress : PointQuantity::stress;
    if ((!by_paraview && !(name.separator == '_' && has_zero)) || (digits & tenth) != 0)
      return std::nullopt;
    if ((digits & last_of_nine) != 0)
      return ColumnMeaning{quantity, numbers_of_nine[name.digit].component, numbers_of_nine[name.digit].mirrored};
    if (by_paraview || digits == first_four || digits == first_six)
      return ColumnMeaning{quantity, name.digit, false};
    return std::nullopt;
  }
  const bool is_point = name.base == "points";
  const auto quantity = is_point || is_name_in(Names(position_names).subspan(1), name.base) ? PointQuantity::position
                        : is_name_in(velocity_names, name.base)                             ? PointQuantity::velocity
                        : is_name_in(displacement_names, name.base)                         ? PointQuantity::displacement
                                                                                            : PointQuantity::other;
  if (quantity == PointQuantity::other || (is_point && name.separator == '\0'))
    return std::nullopt;
  const unsigned first = by_paraview || is_point || (name.separator != '\0' && has_zero) ? 0 : 1;
  if (name.digit < first || name.digit > first + 2)
    return std::nullopt;
  return ColumnMeaning{quantity, name.digit - first, false};
}

ColumnMeaning meaning_among(std::string_view name, const DigitsOfNames& digits)
{
  const std::string plain = plain_name(name);
  static constexpr std::array<std::string_view, 1> points{"points"};
  if (const NameEnd* const end = end_of(plain, effective_names, tensor_ends))
    return {PointQuantity::effective_stress, end->component, end->mirrored};
  for (const Names names : {Names(stress_names), Names(shear_names)})
    if (const NameEnd* const end = end_of(plain, names, tensor_ends))
      return {PointQuantity::stress, end->component, end->mirrored};
  if (const NameEnd* const end = end_of(plain, Names(shear_names).subspan(1), axis_ends))
    return {PointQuantity::stress, end->component};
  if (is_name_in(pore_names, plain))
    return {PointQuantity::pore_pressure, 0};
  if (const auto number = numbered_name(name))
    if (const auto found = digits.find({number->base, number->separator}); found != digits.end())
      if (const auto meaning = numbered_meaning(*number, found->second))
        return *meaning;
  static constexpr std::array<std::pair<PointQuantity, Names>, 4> vectors{{{PointQuantity::position, points},
                                                                           {PointQuantity::position, position_names},
                                                                           {PointQuantity::velocity, velocity_names},
                                                                           {PointQuantity::displacement, displacement_names}}};
  for (const auto& [quantity, names] : vectors)
    if (const NameEnd* const end = end_of(plain, names, axis_ends))
      return {quantity, end->component};
  return {};
}

using NamedUnit = std::pair<std::string_view, Real>;
constexpr std::array<NamedUnit, 13> stress_units{{{"Pa", 1},
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
constexpr std::array<NamedUnit, 4> length_units{{{"m", 1}, {"km", 1e3}, {"cm", 1e-2}, {"mm", 1e-3}}};
constexpr std::array<NamedUnit, 3> speed_units{{{"m/s", 1}, {"cm/s", 1e-2}, {"mm/s", 1e-3}}};
constexpr std::array<NamedUnit, 3> share_units{{{"-", 1}, {"1", 1}, {"%", 1e-2}}};
constexpr std::array<NamedUnit, 5> energy_units{{{"J/m^3", 1}, {"J/m3", 1}, {"J/m\u00b3", 1}, {"kJ/m^3", 1e3}, {"MJ/m^3", 1e6}}};

Real factor_in(std::span<const NamedUnit> units, std::string_view unit)
{
  const auto found = std::ranges::find(units, unit, &NamedUnit::first);
  return found == units.end() ? 0 : found->second;
}

/// The units of which that one is; none if it is not known.
std::span<const NamedUnit> units_like(std::string_view unit)
{
  for (const std::span<const NamedUnit> units :
       {std::span<const NamedUnit>(stress_units), std::span<const NamedUnit>(length_units), std::span<const NamedUnit>(speed_units),
        std::span<const NamedUnit>(share_units), std::span<const NamedUnit>(energy_units)})
    if (factor_in(units, unit) != 0)
      return units;
  return {};
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

std::vector<ColumnMeaning> meanings_of(std::span<const std::string> names)
{
  DigitsOfNames digits;
  for (const std::string& name : names)
    if (const auto number = numbered_name(name))
      digits[{number->base, number->separator}] |= 1U << number->digit;
  std::vector<ColumnMeaning> meanings;
  for (const std::string& name : names)
    meanings.push_back(meaning_among(name, digits));
  return meanings;
}

ColumnMeaning meaning_of(std::string_view name)
{
  const std::string alone(name);
  return meanings_of(std::span(&alone, 1)).front();
}

Real factor_of_unit(std::string_view unit, PointQuantity quantity)
{
  const bool is_length = quantity == PointQuantity::position || quantity == PointQuantity::displacement;
  const std::span<const NamedUnit> lengths = length_units, speeds = speed_units, stresses = stress_units;
  return factor_in(is_length ? lengths : quantity == PointQuantity::velocity ? speeds : stresses, unit);
}

Real factor_between(std::string_view from, std::string_view to)
{
  if (from == to)
    return 1;
  const std::span<const NamedUnit> units = units_like(to);
  return units.empty() ? 0 : factor_in(units, from) / factor_in(units, to);
}

std::string known_units_for(std::string_view unit)
{
  std::vector<std::string_view> names;
  for (const auto& [name, factor] : units_like(unit))
    if (!name.ends_with("m2") && !name.ends_with("m3") && !name.ends_with("\u00b2") && !name.ends_with("\u00b3"))
      names.push_back(name);  // each unit in one way of writing it
  if (names.size() < 2)
    return std::string(unit);
  const std::string_view last = names.back();
  names.pop_back();
  return fmt::format("{} and {}", fmt::join(names, ", "), last);
}

}  // namespace talus
