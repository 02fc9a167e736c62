#include "app/commands/converge/converge_numbers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "app/commands/converge/collected.hpp"
#include "core/error.hpp"
#include "core/word_match.hpp"

namespace talus {

namespace {

constexpr Real relative_rounding = 1e-9;

struct LevelResults {
  std::vector<NamedValue> summary;
  std::optional<HistoryTable> history;
};

/// Columns of a history that describe the steps and not the bodies.
constexpr std::array no_results{"time", "step", "dt", "stage", "residual"};

/// Numbers of a summary that are results; a point at the end: all below that key.  Those of the energy are columns of the history as well.
constexpr std::array results_of_summary{"simulated_time", "watch.fastest", "balances.mass.removed", "runout."};
constexpr std::string_view energy_terms = "balances.energy.terms.";

/// "max(name)" or "min(name)" if the value that is farthest from zero differs from the first and from the last one by more than a
/// hundredth of the range; else nothing.
std::string extreme_of(const std::string& name, std::span<const Real> column)
{
  std::vector<Real> values;
  std::ranges::copy_if(column, std::back_inserter(values), [](Real value) { return !std::isnan(value); });
  if (values.empty())
    return "";
  const auto [low, high] = std::ranges::minmax(values);
  const bool is_max = std::abs(high) >= std::abs(low);
  constexpr Real hundredth = 0.01;
  const Real extreme = is_max ? high : low, near = std::max(hundredth * (high - low), relative_rounding * std::abs(extreme));
  if (std::abs(extreme - values.front()) <= near || std::abs(extreme - values.back()) <= near)
    return "";
  return fmt::format("{}({})", is_max ? "max" : "min", name);
}

/// The names of all physical results.  Columns are asked by `last(...)`, as the summary may have the same name.
std::vector<std::string> usual_names(const LevelResults& finest)
{
  std::vector<std::string> names;
  std::vector<std::string> columns;
  if (finest.history)
    for (std::size_t c = 0; c < finest.history->columns.size(); ++c) {
      const std::string& name = finest.history->columns[c].name;
      columns.push_back(name);
      if (std::ranges::find(no_results, name) != no_results.end())
        continue;
      names.push_back(fmt::format("last({})", name));
      if (const std::string extreme = extreme_of(name, finest.history->values[c]); !extreme.empty())
        names.push_back(extreme);
    }
  for (const NamedValue& number : finest.summary) {
    const bool is_result = std::ranges::any_of(results_of_summary, [&](std::string_view known) {
      return known.ends_with('.') ? number.name.starts_with(known) : number.name == known;
    });
    const bool is_term = number.name.starts_with(energy_terms) && number.unit == "J" && !number.name.ends_with("_start");
    if (is_result || (is_term && std::ranges::find(columns, number.name.substr(energy_terms.size())) == columns.end()))
      names.push_back(number.name);
  }
  return names;
}

/// The largest magnitude of each unit in the history.
std::map<std::string, Real> scales_of(const LevelResults& finest)
{
  std::map<std::string, Real> scales;
  if (finest.history)
    for (std::size_t c = 0; c < finest.history->columns.size(); ++c)
      for (const Real value : finest.history->values[c])
        if (std::isfinite(value)) {
          Real& scale = scales[finest.history->columns[c].unit];
          scale = std::max(scale, std::abs(value));
        }
  return scales;
}

std::vector<LevelResults> results_of(const ConvergePlan& plan)
{
  std::vector<LevelResults> all;
  for (const ConvergeLevel& level : plan.levels)
    all.push_back({read_summary(level.folder / "summary.json").numbers, history_in(level.folder)});
  return all;
}

}  // namespace

std::optional<Real> ConvergeNumber::relative() const noexcept
{
  if (!judged.uncertainty || values.back() == 0)
    return std::nullopt;
  return *judged.uncertainty / std::abs(values.back());
}

std::vector<ConvergeNumber> numbers_of(const ConvergePlan& plan, const std::vector<std::string>& collect)
{
  const std::vector<LevelResults> results = results_of(plan);
  const LevelResults& finest = results.back();
  std::vector<Real> sizes;
  for (const ConvergeLevel& level : plan.levels)
    sizes.push_back(level.size);
  std::map<std::string, Real> scales = scales_of(finest);
  std::vector<ConvergeNumber> numbers;
  std::string unknown;
  for (const std::string& name : collect.empty() ? usual_names(finest) : collect) {
    ConvergeNumber number{name.starts_with("last(") ? column_of(name) : name, "", {}, {}};
    bool found = false;
    for (const LevelResults& level : results) {
      const auto value = collected(level.summary, level.history, name);
      found = found || value;
      number.values.push_back(value ? value->value : std::numeric_limits<Real>::quiet_NaN());
      if (value)
        number.unit = value->unit;
    }
    if (!found) {
      const auto near = closest_match(column_of(name), known_names(finest.summary, finest.history));
      unknown += fmt::format("{}--collect: no level has a number \"{}\"{}", unknown.empty() ? "" : "\n", name,
                             near ? fmt::format(" — did you mean \"{}\"?", *near)
                                  : "; names are the keys of summary.json, joined by points, and the columns of history.csv");
      continue;
    }
    Real scale = scales[number.unit];
    for (const Real value : number.values)
      scale = std::isfinite(value) ? std::max(scale, std::abs(value)) : scale;
    number.judged = extrapolate(sizes, number.values, relative_rounding * scale);
    const bool is_zero = std::ranges::all_of(number.values, [&](Real value) { return std::abs(value) <= relative_rounding * scale; });
    if (is_zero)
      number.judged = {Convergence::constant, Trend::stays, std::nullopt, 0, 0};
    numbers.push_back(std::move(number));
  }
  if (!unknown.empty())
    throw Error(unknown);
  return numbers;
}

std::vector<std::string> complaints(std::span<const ConvergeNumber> numbers)
{
  constexpr std::size_t most_names = 6;
  std::map<Convergence, std::vector<std::string>> names;
  std::size_t count = 0;
  for (const ConvergeNumber& number : numbers)
    if (!number.is_told()) {
      names[number.judged.verdict].push_back(number.name);
      ++count;
    }
  std::vector<std::string> all;
  if (count > 0)
    all.push_back(fmt::format("{} of {} numbers do NOT CONVERGE at these sizes: nothing is extrapolated, and their uncertainty is unknown",
                              count, numbers.size()));
  for (auto& [verdict, list] : names) {
    const std::size_t more = list.size() > most_names ? list.size() - most_names : 0;
    list.resize(list.size() - more);
    all.push_back(fmt::format("{}: {}: {}{}", enum_names(Convergence{})[static_cast<std::size_t>(verdict)], meaning_of(verdict),
                              fmt::join(list, ", "), more > 0 ? fmt::format(" and {} more", more) : ""));
  }
  return all;
}

}  // namespace talus
