#include "app/commands/fos/fos_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"

namespace talus {

namespace {

/// The value of a column at a time, linear between rows.
Real value_at(Real time, std::span<const Real> times, std::span<const Real> values)
{
  const auto after = static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), time) - times.begin());
  if (after == 0 || after == times.size())
    return after == 0 ? values.front() : values.back();
  const Real share = (time - times[after - 1]) / (times[after] - times[after - 1]);
  return values[after - 1] + share * (values[after] - values[after - 1]);
}

bool is_known(Real factor, std::span<const FosTrial> trials)
{
  return std::any_of(trials.begin(), trials.end(), [&](const FosTrial& trial) { return trial.factor == factor; });
}

/// The value rounded to two digits.
Real rounded(Real value)
{
  const Real digit = std::pow(10, std::floor(std::log10(value)) - 1);
  return std::stod(fmt::format("{:.6g}", std::round(value / digit) * digit));
}

}  // namespace

Real usual_duration(const AtRest& bodies) noexcept
{
  return rounded(std::max(3 * std::sqrt(bodies.height / bodies.gravity), 20 * bodies.height / bodies.wave_speed));
}

std::optional<Motion> motion_of(const HistoryTable& history, std::span<const std::string> moved, const AtRest& bodies)
{
  const auto time = history["time"], kinetic = history["kinetic"], mass = history["mass"];
  if (!time || !kinetic || !mass || time->size() < 2)
    return std::nullopt;
  std::vector<Real> largest(time->size(), 0);
  for (const std::string& name : moved) {
    const auto column = history[name];
    if (!column)
      return std::nullopt;
    for (std::size_t row = 0; row < column->size(); ++row)
      if (!std::isnan((*column)[row]))
        largest[row] = std::max(largest[row], (*column)[row]);
  }
  Motion motion;
  motion.duration = time->back() - time->front();
  motion.moved = largest.back();
  const Real noticed = 0.5 * bodies.settlement(), half = value_at(time->front() + motion.duration / 2, *time, largest);
  if (const Real first = std::max(half, noticed); first > 0)
    motion.growth = (motion.moved - half) / first;
  Real late = 0, peak = 0;
  int rows = 0;
  for (std::size_t row = 0; row < time->size(); ++row) {
    peak = std::max(peak, (*kinetic)[row]);
    if ((*time)[row] >= time->back() - 0.1 * motion.duration)
      late += (*kinetic)[row], ++rows;
  }
  if (peak > 0) {
    motion.liveliness = late / rows / peak;
  } else {
    const auto at = [&](Real share) { return value_at(time->front() + share * motion.duration, *time, largest); };
    const Real middle = at(2.0 / 3) - at(1.0 / 3), last = motion.moved - at(2.0 / 3);
    motion.steadiness = middle > 0 ? last / middle : last > 0 ? std::numeric_limits<Real>::infinity() : 0;
  }
  return motion;
}

Verdict judge(const Motion& motion, const FosCriterion& criterion) noexcept
{
  if (motion.steadiness)
    return motion.growth <= criterion.growth || *motion.steadiness <= criterion.steadiness ? Verdict::holds : Verdict::fails;
  if (motion.growth <= criterion.growth / clear_margin)
    return Verdict::holds;
  if (motion.growth > criterion.growth * clear_margin)
    return Verdict::fails;
  const bool grows = !(motion.growth <= criterion.growth);
  const bool moves = motion.liveliness && !(*motion.liveliness <= criterion.liveliness);
  return grows == moves ? (grows ? Verdict::fails : Verdict::holds) : Verdict::unclear;
}

Bracket bracket_of(std::span<const FosTrial> trials)
{
  Bracket bracket;
  for (const FosTrial& trial : trials)
    if (trial.verdict == Verdict::fails)
      bracket.high = std::min(bracket.high.value_or(trial.factor), trial.factor);
  for (const FosTrial& trial : trials) {
    if (trial.verdict != Verdict::holds)
      continue;
    if (bracket.high && trial.factor > *bracket.high)
      bracket.out_of_order.push_back(trial.factor);
    else
      bracket.low = std::max(bracket.low.value_or(trial.factor), trial.factor);
  }
  std::sort(bracket.out_of_order.begin(), bracket.out_of_order.end());
  return bracket;
}

std::vector<Real> next_factors(std::span<const FosTrial> trials, const FosRange& range, std::size_t jobs)
{
  const auto [low, high, out_of_order] = bracket_of(trials);
  std::vector<Real> next;
  if (!low || !high) {
    for (Real factor = range.from; !low; factor /= 2) {
      if (factor < range.from / farthest)
        throw RunError(
            fmt::format("fails even where the strength is divided by {:.6g}: it does not stand at all, or moves for another reason; "
                        "look at the trials",
                        2 * factor));
      if (!is_known(factor, trials)) {
        next.push_back(factor);
        break;
      }
    }
    for (Real factor = range.to; !high; factor *= 2) {
      if (factor > range.to * farthest)
        throw RunError(
            fmt::format("holds even where the strength is divided by {:.6g}: nothing here fails by lack of strength", factor / 2));
      if (!is_known(factor, trials)) {
        next.push_back(factor);
        break;
      }
    }
    next.resize(std::min(next.size(), jobs));
    return next;
  }
  const Real grid = range.width / 2, left = *high - *low;
  if (left <= range.width * (1 + 1e-9))
    return next;
  const auto enough = static_cast<std::size_t>(std::ceil(left / range.width * (1 - 1e-9))) - 1;
  const std::size_t parts = std::clamp<std::size_t>(enough, 1, jobs) + 1;
  for (std::size_t k = 1; k < parts; ++k) {
    const Real factor = std::round((*low + left * static_cast<Real>(k) / static_cast<Real>(parts)) / grid) * grid;
    const Real tidy = std::stod(fmt::format("{:.9g}", factor));
    if (tidy > *low && tidy < *high && (next.empty() || tidy > next.back()))
      next.push_back(tidy);
  }
  return next;
}

}  // namespace talus
