// The tables of a convergence study: on the terminal, convergence.csv, convergence.json.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/commands/converge/converge_numbers.hpp"
#include "core/version.hpp"
#include "io/output/convergence_json.hpp"
#include "io/output/csv.hpp"

namespace talus {

namespace {

constexpr std::size_t width_of_name = 19, shown_levels = 3;

std::string_view word_of(Convergence verdict) { return enum_names(Convergence{})[static_cast<std::size_t>(verdict)]; }
std::string_view word_of(Trend trend) { return enum_names(Trend{})[static_cast<std::size_t>(trend)]; }
std::string_view word_of(CaseState state) { return enum_names(CaseState{})[static_cast<std::size_t>(state)]; }

/// A line of the table of numbers, 100 columns wide.
struct NumberLine {
  std::string name;
  std::array<std::string, shown_levels> values;
  std::string_view trend;
  std::string change, order, extrapolated, uncertainty;
  std::string_view verdict;
};

std::string print(const NumberLine& line)
{
  std::string text = fmt::format("{:{}}", line.name, width_of_name);
  if (line.name.size() > width_of_name)
    text += fmt::format("\n{:{}}", "", width_of_name);
  for (const std::string& value : line.values)
    text += fmt::format("{:>11}", value);
  return text + fmt::format("{:>6}{:>7}{:>6}{:>11}{:>7} {}\n", line.trend, line.change, line.order, line.extrapolated, line.uncertainty,
                            line.verdict);
}

std::string short_number(const std::optional<Real>& value) { return value && !std::isnan(*value) ? fmt::format("{:.4g}", *value) : "-"; }

/// A share in percent with two digits, in at most 7 characters; with its sign if `is_signed`.
std::string in_percent(const std::optional<Real>& share, bool is_signed = false)
{
  constexpr Real least = 1e-4, tenth = 0.001, whole = 0.1, most = 9.99;
  if (!share || std::isnan(*share))
    return "-";
  const Real size = std::abs(*share);
  const std::string sign = !is_signed || *share == 0 ? "" : *share > 0 ? "+" : "-";
  if (size == 0)
    return "0%";
  if (size < least)
    return "<0.01%";
  if (size > most)
    return (sign == "-" ? "<" : ">") + sign + "999%";
  const std::string digits = size < tenth ? "{:.2f}" : size < whole ? "{:.2g}" : "{:.0f}";
  return sign + fmt::format(fmt::runtime(digits), 100 * size) + '%';
}

/// The change between the two finest levels over the finest value [-].
std::optional<Real> last_change(const ConvergeNumber& number)
{
  const Real fine = number.values.back(), coarse = number.values[number.values.size() - 2];
  if (number.judged.trend == Trend::stays && number.judged.verdict == Convergence::constant)
    return 0;
  return fine == 0 ? std::nullopt : std::optional((fine - coarse) / std::abs(fine));
}

bool is_zero(const ConvergeNumber& number) { return number.judged.extrapolated == 0 && number.judged.uncertainty == 0; }

std::optional<Real> finite(const std::optional<Real>& value) { return value && std::isfinite(*value) ? value : std::nullopt; }

}  // namespace

std::string print_levels(const ConvergePlan& plan)
{
  std::string text =
      fmt::format("{:<12} {:>13} {:>10} {:>10}  {:<10} {}\n", "level", "mean size [m]", "cells", "particles", "state", "changes");
  for (const ConvergeLevel& level : plan.levels) {
    const std::string changes =
        level.of_mesh.empty() ? "none: the scene as it is" : level.of_mesh.front() + (level.of_mesh.size() > 1 ? ", ..." : "");
    text += fmt::format("{:<12} {:>13.4g} {:>10} {:>10}  {:<10} {}\n", level.folder.filename().string(), level.size, level.cells,
                        level.particles, word_of(status_of(level, plan.quick).state), changes);
  }
  return text;
}

std::string print_numbers(const ConvergePlan& plan, std::span<const ConvergeNumber> numbers)
{
  const std::size_t first = plan.levels.size() - shown_levels;
  NumberLine heading{"cells of", {}, "trend", "change", "order", "extrapol.", "+-", "verdict"};
  for (std::size_t k = 0; k < shown_levels; ++k)
    heading.values[k] = fmt::format("{:.3g} m", plan.levels[first + k].size);
  std::string text = print(heading);
  std::size_t zeros = 0;
  for (const ConvergeNumber& number : numbers) {
    if (is_zero(number)) {
      ++zeros;
      continue;
    }
    const Extrapolation& judged = number.judged;
    NumberLine line{csv_heading({number.name, number.unit}),
                    {},
                    word_of(judged.trend),
                    in_percent(last_change(number), true),
                    judged.order ? fmt::format("{:.1f}", *judged.order) : "-",
                    short_number(judged.extrapolated),
                    in_percent(number.relative()),
                    word_of(judged.verdict)};
    for (std::size_t k = 0; k < shown_levels; ++k)
      line.values[k] = short_number(number.values[first + k]);
    text += print(line);
  }
  if (zeros > 0)
    text += fmt::format("zero at all sizes: {} number{}\n", zeros, zeros == 1 ? "" : "s");
  return text;
}

std::string convergence_csv(const ConvergePlan& plan, std::span<const ConvergeNumber> numbers)
{
  std::vector<CsvColumn> columns{{"quantity"}, {"unit"}};
  for (std::size_t k = 1; k <= plan.levels.size(); ++k)
    columns.push_back({fmt::format("cell_size_{}", k), "m"});
  for (std::size_t k = 1; k <= plan.levels.size(); ++k)
    columns.push_back({fmt::format("value_{}", k)});
  for (const char* name : {"trend", "order", "extrapolated", "uncertainty", "verdict"})
    columns.push_back({name});
  const auto cell = [](const std::optional<Real>& value) { return value && std::isfinite(*value) ? fmt::format(",{}", *value) : ","; };
  std::string text = csv_header(columns);
  for (const ConvergeNumber& number : numbers) {
    text += csv_cell(number.name) + ',' + csv_cell(number.unit);
    for (const ConvergeLevel& level : plan.levels)
      text += fmt::format(",{}", level.size);
    for (const Real value : number.values)
      text += cell(value);
    const Extrapolation& judged = number.judged;
    text += fmt::format(",{}{}{}{},{}\n", word_of(judged.trend), cell(judged.order), cell(judged.extrapolated), cell(judged.uncertainty),
                        csv_cell(std::string(word_of(judged.verdict))));
  }
  return text;
}

std::string convergence_json(const ConvergePlan& plan, Real ratio, std::span<const ConvergeNumber> numbers,
                             const std::vector<std::string>& warnings)
{
  ConvergenceRecord record{.scene = plan.scene.string(),
                           .commit = std::string(version().commit),
                           .ratio = ratio,
                           .safety_factor = safety_factor,
                           .lowest_order = lowest_order,
                           .highest_order = highest_order,
                           .formal_order = formal_order,
                           .levels = {},
                           .numbers = {},
                           .warnings = warnings};
  for (const ConvergeLevel& level : plan.levels)
    record.levels.push_back({.factor = level.factor,
                             .size = level.size,
                             .cells = level.cells,
                             .particles = level.particles,
                             .changes = level.changes,
                             .state = std::string(word_of(status_of(level, plan.quick).state)),
                             .folder = level.folder.filename().string(),
                             .command = command_of(plan.scene, level, plan.quick),
                             .scene_digest = level.scene_digest});
  for (const ConvergeNumber& number : numbers) {
    ConvergenceNumberRecord row{.name = number.name,
                                .unit = number.unit,
                                .values = {},
                                .trend = std::string(word_of(number.judged.trend)),
                                .verdict = std::string(word_of(number.judged.verdict)),
                                .order = finite(number.judged.order),
                                .extrapolated = number.judged.extrapolated,
                                .uncertainty = number.judged.uncertainty};
    for (const Real value : number.values)
      row.values.push_back(finite(value));
    record.numbers.push_back(std::move(row));
  }
  return to_json(record);
}

}  // namespace talus
