#pragma once
// Decision when to redistribute the work of a run among its ranks.
#include <cstdint>
#include <optional>

#include "core/types.hpp"

namespace talus {

/// The rule of the ski-rental problem: the work is redistributed when the accumulated cost of imbalance since the last redistribution
/// equals the cost of a redistribution.  The total is never more than twice that of the best schedule with knowledge of the future.  All
/// ranks call with times [s] that they have agreed on, and so decide alike.
class RebalancePolicy {
 public:
  /// `every`: redistribute after so many steps whatever it costs; 0: never; nothing: when it pays.  `step`: number of steps at the last
  /// distribution; `cost`: its time [s].
  RebalancePolicy(std::optional<std::int64_t> every, std::int64_t step, Real cost) noexcept;

  /// Whether to check the distribution after `step` steps.
  bool looks(std::int64_t step) const noexcept;
  /// Whether a check always leads to a redistribution.
  bool always_moves() const noexcept { return every_.has_value(); }
  /// Records that steps since the last check took `seconds` [s] each and that the busiest rank had `imbalance` times the mean work.  True
  /// if the accumulated loss is worth a redistribution, provided that a better one exists.
  bool has_lost_enough(std::int64_t step, Real seconds, Real imbalance) noexcept;
  /// Whether a new distribution with imbalance `then` is better enough than the present one with `now`.  If not, the next check comes
  /// later.
  bool gains(Real now, Real then) noexcept;
  /// Records a redistribution after `step` steps, which took `cost` seconds.
  void moved(std::int64_t step, Real cost) noexcept;
  /// Disables further redistributions.
  void abort_run() noexcept { every_ = 0; }

 private:
  std::optional<std::int64_t> every_;
  Real cost_;
  std::int64_t moved_, looked_;  // numbers of steps at the last redistribution and the last check
  std::int64_t interval_;        // steps between two checks
  Real lost_ = 0;                // loss since the last redistribution, or since no better one was found [s]
};

}  // namespace talus
