#pragma once
// When it pays to share the work of a run out anew among its ranks.
#include <cstdint>
#include <optional>

#include "core/types.hpp"

namespace talus {

/// The rule of one who hires skis and might buy them: shares move when their unevenness has cost, since they were made, what moving them
/// costs.  So both together are never more than twice what the best would have been that knew the future.  All ranks ask and tell alike, in
/// seconds that they have agreed on, and so come to the same answers.
class RebalancePolicy {
 public:
  /// `every`: move after so many steps whatever it costs; 0: never; without a number: when it pays.  `step`: steps done when the shares were
  /// made; `cost`: what that took [s].
  RebalancePolicy(std::optional<std::int64_t> every, std::int64_t step, Real cost) noexcept;

  /// Whether it is time to look at the shares, `step` steps being done.
  bool looks(std::int64_t step) const noexcept;
  /// Whether nothing more is asked then.
  bool always_moves() const noexcept { return every_.has_value(); }
  /// Steps since the last look took `seconds` [s] each, the busiest rank having `imbalance` times the mean of the work.  True if enough has been
  /// lost by that for a move, should there be better shares.
  bool has_lost_enough(std::int64_t step, Real seconds, Real imbalance) noexcept;
  /// Whether better shares are good enough: an imbalance of `then` for one of `now`.  If not, it takes longer until the next look.
  bool gains(Real now, Real then) noexcept;
  /// Shares have moved, which took so long [s].
  void moved(std::int64_t step, Real cost) noexcept;
  /// They never will again.
  void abort_run() noexcept { every_ = 0; }

 private:
  std::optional<std::int64_t> every_;
  Real cost_;
  std::int64_t moved_, looked_;  // steps done then
  std::int64_t interval_;        // steps between two looks
  Real lost_ = 0;                // since shares moved, or since there were none better [s]
};

}  // namespace talus
