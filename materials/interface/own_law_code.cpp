#include "materials/interface/own_law_code.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/error.hpp"
#include "core/word_match.hpp"

namespace talus {

namespace {

/// A name that a scene or a table can have: letters, digits and underscores, none of the first a digit.
bool is_key(const char* text)
{
  if (text == nullptr || *text == '\0' || std::isdigit(static_cast<unsigned char>(*text)) != 0)
    return false;
  const std::string_view all(text);
  return std::ranges::all_of(all, [](char c) { return c == '_' || std::isalnum(static_cast<unsigned char>(c)) != 0; });
}

std::string_view text_of(const char* text, std::string_view otherwise) { return text != nullptr ? std::string_view(text) : otherwise; }

/// The version stands first in every version of the interface; nothing else is read before it is known.
void check_head(const talus_law& law)
{
  if (law.version != TALUS_LAW_VERSION)
    throw Error(
        fmt::format("it was compiled with version {} of talus_law.h, and this program has version {}: compile it again with the "
                    "header of this program",
                    law.version, TALUS_LAW_VERSION));
  if (!is_key(law.name))
    throw Error("its name has to consist of letters, digits and underscores");
  if (law.measure != TALUS_LAW_STRAIN && law.measure != TALUS_LAW_DEFORMATION)
    throw Error(fmt::format("measure is {}: write TALUS_LAW_STRAIN or TALUS_LAW_DEFORMATION", law.measure));
  if (law.begin == nullptr || law.update == nullptr)
    throw Error(fmt::format("it has no function {}", law.begin == nullptr ? "begin" : "update"));
  if (law.n_parameters < 0 || law.n_variables < 0 || law.n_constants < 0)
    throw Error("n_parameters, n_variables or n_constants is negative");
  if ((law.n_parameters > 0 && law.parameters == nullptr) || (law.n_variables > 0 && law.variables == nullptr))
    throw Error("parameters or variables is NULL, and their number is not 0");
}

bool has_limits(const talus_law_parameter& one) noexcept { return one.low != 0 || one.high != 0; }

void check_parameters(std::span<const talus_law_parameter> all)
{
  for (std::size_t i = 0; i < all.size(); ++i) {
    const talus_law_parameter& one = all[i];
    if (!is_key(one.key))
      throw Error(fmt::format("the key of parameter {} has to consist of letters, digits and underscores", i));
    for (std::size_t before = 0; before < i; ++before)
      if (std::string_view(all[before].key) == one.key)
        throw Error(fmt::format("two parameters have the key \"{}\"", one.key));
    if (std::isnan(one.low) || std::isnan(one.high) || one.low > one.high)
      throw Error(fmt::format("the limits of parameter \"{}\" contain no number", one.key));
    if (has_limits(one) && !std::isnan(one.value) && !(one.low <= one.value && one.value <= one.high))
      throw Error(fmt::format("the default of parameter \"{}\" is beyond its limits", one.key));
  }
}

/// Throws Error for a history variable that is wrong in itself, or has the key of one before it.
void check_variable(const talus_law_variable& one, std::size_t number, std::span<const HistoryVariable> before)
{
  if (!is_key(one.key))
    throw Error(fmt::format("the key of history variable {} has to consist of letters, digits and underscores", number));
  if (std::ranges::any_of(before, [&](const HistoryVariable& other) { return other.key == one.key; }))
    throw Error(fmt::format("two history variables have the key \"{}\"", one.key));
  if (one.components != 1 && one.components != 6)
    throw Error(fmt::format("history variable \"{}\" has {} components: 1 or 6", one.key, one.components));
  const std::string_view key(one.key);
  if (one.components != 1 && (key == "plastic_work" || key == "plastic_strain"))
    throw Error(fmt::format("history variable \"{}\" is a number and has 1 component", key));
}

std::string limits_of(const talus_law_parameter& one)
{
  if (std::isinf(one.high))
    return fmt::format("at least {:.6g}", one.low);
  return std::isinf(one.low) ? fmt::format("at most {:.6g}", one.high) : fmt::format("from {:.6g} to {:.6g}", one.low, one.high);
}

std::optional<std::string> limit_broken(const OwnLawCode& code, const talus_law_parameter& one, Real value)
{
  if (!has_limits(one) || (one.low <= value && value <= one.high))
    return std::nullopt;
  return fmt::format("{:.6g} is not allowed: {} [{}] of the law {} is {}", value, one.key, text_of(one.unit, "-"), code.description().name,
                     limits_of(one));
}

}  // namespace

OwnLawCode::OwnLawCode(const talus_law& law, OwnLawOrigin origin) : origin_(std::move(origin))
{
  check_head(law);
  law_ = law;
  check_parameters(parameters());
  int width = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(law.n_variables); ++i) {
    const talus_law_variable& one = law.variables[i];
    check_variable(one, i, variables_);
    variables_.push_back({one.key, text_of(one.unit, "-"), text_of(one.meaning, one.key), width, one.components});
    if (one.components == 6 && one.turns != 0 && law.measure == TALUS_LAW_STRAIN)
      turning_.push_back(width);
    width += one.components;
  }
  name_ = fmt::format("{} of {}", law.name, origin_.library);
  summary_ = text_of(law.summary, law.name);
  description_ = {.name = name_,
                  .summary = summary_,
                  .variables = variables_,
                  .history_width = width,
                  .starts_from_stress = law.measure == TALUS_LAW_STRAIN || law.prestress != nullptr,
                  .has_strength = law.weaken != nullptr,
                  .is_isochoric = (law.flags & TALUS_LAW_ISOCHORIC) != 0,
                  .is_fluid = (law.flags & TALUS_LAW_FLUID) != 0};
}

std::optional<std::string> beyond_limits(const OwnLawCode& code, std::span<const Real> values)
{
  for (std::size_t i = 0; i < values.size(); ++i)
    if (auto wrong = limit_broken(code, code.parameters()[i], values[i]))
      return wrong;
  return std::nullopt;
}

OwnLawValues values_of(const OwnLawCode& code, const NamedNumbers& given)
{
  OwnLawValues result;
  std::vector<std::string> known;
  for (const talus_law_parameter& one : code.parameters())
    known.emplace_back(one.key);
  for (const NamedNumber& number : given.all)
    if (std::ranges::find(known, number.name) == known.end())
      result.problems.push_back({number.name, fmt::format("the law {} has no parameter \"{}\"{}", code.description().name, number.name,
                                                          suggestion(number.name, known))});
  for (const talus_law_parameter& one : code.parameters()) {
    const Real* const value = given.find(one.key);
    if (value == nullptr && std::isnan(one.value))
      result.problems.push_back({"", fmt::format("missing parameter \"{}\" [{}] of the law {}: {}", one.key, text_of(one.unit, "-"),
                                                 code.description().name, text_of(one.meaning, one.key))});
    else if (auto wrong = value != nullptr ? limit_broken(code, one, *value) : std::nullopt)
      result.problems.push_back({one.key, std::move(*wrong)});
    result.values.push_back(value != nullptr ? *value : one.value);
  }
  return result;
}

}  // namespace talus
