#include "app/commands/converge/richardson.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talus {

namespace {

/// Three successive values, from coarse to fine.
struct Triple {
  Real change_coarse, change_fine;  ///< coarser minus finer
  Real ratio_coarse, ratio_fine;
};

Triple triple_at(std::span<const Real> sizes, std::span<const Real> values, std::size_t first) noexcept
{
  return {values[first] - values[first + 1], values[first + 1] - values[first + 2], sizes[first] / sizes[first + 1],
          sizes[first + 1] / sizes[first + 2]};
}

/// The verdict on three values, and their order if there is one.
Extrapolation judge(const Triple& t, Real floor) noexcept
{
  Extrapolation result;
  const bool same_coarse = std::abs(t.change_coarse) <= floor, same_fine = std::abs(t.change_fine) <= floor;
  const auto say = [&](Convergence verdict) {
    result.verdict = verdict;
    return result;
  };
  if (same_fine)
    return say(same_coarse ? Convergence::constant : Convergence::undecided);
  if (same_coarse)
    return say(Convergence::diverges);
  if ((t.change_coarse > 0) != (t.change_fine > 0))
    return say(std::abs(t.change_fine) < std::abs(t.change_coarse) ? Convergence::oscillates : Convergence::oscillates_and_grows);
  result.order = observed_order(t.change_coarse, t.change_fine, t.ratio_coarse, t.ratio_fine);
  if (!result.order)
    return say(Convergence::diverges);
  return say(*result.order < lowest_order    ? Convergence::order_low
             : *result.order > highest_order ? Convergence::order_high
                                             : Convergence::converges);
}

Trend trend_of(std::span<const Real> values, Real floor) noexcept
{
  bool up = false, down = false;
  for (std::size_t i = 0; i + 1 < values.size(); ++i) {
    up = up || values[i + 1] - values[i] > floor;
    down = down || values[i] - values[i + 1] > floor;
  }
  return up && down ? Trend::turns : up ? Trend::rises : down ? Trend::falls : Trend::stays;
}

}  // namespace

std::string_view meaning_of(Convergence verdict) noexcept
{
  switch (verdict) {
    case Convergence::converges: return "the changes have one sign and fall with an order between 0.5 and 3";
    case Convergence::constant: return "the same at all sizes, but for rounding";
    case Convergence::oscillates: return "oscillatory convergence: the changes alternate in sign and fall";
    case Convergence::oscillates_and_grows: return "oscillatory divergence: the changes alternate in sign and do not fall";
    case Convergence::diverges: return "divergence: the changes have one sign and do not fall";
    case Convergence::order_low: return "the changes fall too slowly: where they lead cannot be told";
    case Convergence::order_high: return "the changes fall faster than the method converges, which is an accident of these sizes";
    case Convergence::unsteady: return "the order of the three finest sizes is not that of the next coarser ones";
    case Convergence::undecided: return "the two finest values are equal and the coarser one is not: no order follows";
    case Convergence::no_value: break;
  }
  return "not known at every size";
}

std::optional<Real> observed_order(Real change_coarse, Real change_fine, Real ratio_coarse, Real ratio_fine) noexcept
{
  constexpr Real largest = 20;
  constexpr int halvings = 60;
  const Real wanted = std::log(change_coarse / change_fine), coarse = std::log(ratio_coarse), fine = std::log(ratio_fine);
  const auto log_of_changes = [&](Real p) { return p * fine + std::log(std::expm1(p * coarse) / std::expm1(p * fine)); };
  if (!(wanted > std::log(coarse / fine)))  // the limit for p = 0
    return std::nullopt;
  if (wanted > log_of_changes(largest))
    return std::numeric_limits<Real>::infinity();
  Real low = 0, high = largest;
  for (int i = 0; i < halvings; ++i) {
    const Real middle = (low + high) / 2;
    (log_of_changes(middle) < wanted ? low : high) = middle;
  }
  return (low + high) / 2;
}

Extrapolation extrapolate(std::span<const Real> sizes, std::span<const Real> values, Real floor) noexcept
{
  if (!std::ranges::all_of(values, [](Real value) { return std::isfinite(value); }))
    return {};
  const std::size_t finest = sizes.size() - 3;
  const Triple triple = triple_at(sizes, values, finest);
  Extrapolation result = judge(triple, floor);
  result.trend = trend_of(values, floor);
  const Real value = values.back();
  if (result.verdict == Convergence::constant && result.trend == Trend::stays) {
    result.extrapolated = value;
    result.uncertainty = std::ranges::max(values) - std::ranges::min(values);
    return result;
  }
  if (result.verdict == Convergence::constant)  // only the finest are equal
    result.verdict = Convergence::undecided;
  if (result.verdict != Convergence::converges)
    return result;
  if (finest > 0) {
    const Extrapolation before = judge(triple_at(sizes, values, finest - 1), floor);
    if (!before.order || std::abs(*before.order - *result.order) > steady_within) {
      result.verdict = Convergence::unsteady;
      return result;
    }
  }
  const auto share = [&](Real order) { return triple.change_fine / std::expm1(order * std::log(triple.ratio_fine)); };
  result.extrapolated = value - share(*result.order);
  result.uncertainty = safety_factor * std::abs(share(std::min(*result.order, formal_order)));
  return result;
}

}  // namespace talus
