#include "core/parallel/rebalance_policy.hpp"

#include <algorithm>

namespace talus {

namespace {

constexpr std::int64_t first_interval = 50, longest_interval = 3200;  // steps
/// The new imbalance must be less than this fraction of the present one: particle counts predict times only roughly.
constexpr Real good_enough = 0.95;

}  // namespace

RebalancePolicy::RebalancePolicy(std::optional<std::int64_t> every, std::int64_t step, Real cost) noexcept
    : every_(every), cost_(cost), moved_(step), looked_(step), interval_(first_interval)
{}

bool RebalancePolicy::looks(std::int64_t step) const noexcept
{
  if (every_)
    return *every_ > 0 && step - moved_ >= *every_;
  return step - looked_ >= interval_;
}

bool RebalancePolicy::has_lost_enough(std::int64_t step, Real seconds, Real imbalance) noexcept
{
  lost_ += static_cast<Real>(step - looked_) * seconds * (1 - 1 / std::max(imbalance, Real{1}));
  looked_ = step;
  return lost_ > cost_;
}

bool RebalancePolicy::gains(Real now, Real then) noexcept
{
  if (then <= good_enough * now)
    return true;
  lost_ = 0;
  interval_ = std::min(2 * interval_, longest_interval);
  return false;
}

void RebalancePolicy::moved(std::int64_t step, Real cost) noexcept { *this = RebalancePolicy(every_, step, cost); }

}  // namespace talus
