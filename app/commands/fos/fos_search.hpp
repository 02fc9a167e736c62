#pragma once
// The search for a factor of safety: the verdict on a trial, and the choice of the next factors.
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/output/csv.hpp"

namespace talus {

/// Properties of the bodies before their strength is divided.
struct AtRest {
  Real gravity{};     ///< gravity [m/s^2]
  Real height{};      ///< height of the bodies along gravity [m]
  Real wave_speed{};  ///< lowest wave speed of their materials [m/s]
  /// The settlement of a body of this height under its own weight, rho g h^2 / (rho c^2) [m].
  Real settlement() const noexcept { return gravity * height * height / (wave_speed * wave_speed); }
};

/// The default duration of a trial [s]: three times the free fall over half the height, or twenty wave transit times, whichever is longer;
/// rounded to two digits.
Real usual_duration(const AtRest& bodies) noexcept;

/// Two measures of whether a slope fails, from the history after its strength was divided.
struct Motion {
  Real moved = 0;  ///< displacement at the end, the largest of the columns [m]
  /// Displacement in the second half of the time over that in the first half, or over half of the settlement if that is larger [-].
  Real growth = 0;
  /// Kinetic energy in the last tenth of the time over its peak [-]; nothing in equilibria, which have none.
  std::optional<Real> liveliness;
  /// Of equilibria under the same loads: displacement in the last third over that in the middle third [-].
  std::optional<Real> steadiness;
  Real duration = 0;  ///< duration of the trial [s]
};
/// Nothing if the history does not have the columns or has less than two rows.
std::optional<Motion> motion_of(const HistoryTable& history, std::span<const std::string> moved, const AtRest& bodies);

enum class Verdict : std::uint8_t { holds, fails, unclear };
constexpr std::array<std::string_view, 3> enum_names(Verdict) { return {"holds", "fails", "unclear"}; }

/// The limits of the measures above which the slope counts as failing.
struct FosCriterion {
  Real growth = 0.1, liveliness = 5e-4, steadiness = 0.5;
};
/// A growth that is below or above its limit by this factor decides alone: particles may oscillate, and where hardly anything moves the
/// peak is as small.  In between both measures have to agree; if they contradict each other the verdict is unclear.  Equilibria fail
/// if growth and steadiness are above their limits: what comes to rest moves less and less.
inline constexpr Real clear_margin = 5;
Verdict judge(const Motion& motion, const FosCriterion& criterion) noexcept;

/// A factor with its result.
struct FosTrial {
  Real factor{};
  Verdict verdict = Verdict::unclear;
  std::optional<Motion> motion;  ///< nothing if the run failed
  bool by_growth_alone = false;  ///< the measures contradicted each other also in the longest trial
  std::string message;           ///< message of a run that failed
};

/// The factor of safety is above `low`, which holds, and below `high`, the lowest that fails.
struct Bracket {
  std::optional<Real> low, high;
  std::vector<Real> out_of_order;  ///< factors above `high` that hold
};
Bracket bracket_of(std::span<const FosTrial> trials);

struct FosRange {
  Real from = 0.5, to = 3, width = 0.02;
};
/// The factors to be tried simultaneously, at most `jobs`; none when the bracket is narrow enough.  First the ends of the range, which is
/// extended up to `farthest` times, then equal parts inside, at multiples of half the width.  Throws Error if all factors hold or all fail.
std::vector<Real> next_factors(std::span<const FosTrial> trials, const FosRange& range, std::size_t jobs);
inline constexpr Real farthest = 8;

}  // namespace talus
