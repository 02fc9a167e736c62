#pragma once
// Root of one equation with one unknown, found whatever the slope does: for return maps.
#include <algorithm>
#include <cmath>
#include <concepts>

#include "core/types.hpp"

namespace talus {

/// A function at a point.
struct ValueAndSlope {
  Real value, slope;
};

/// The x in (0, high] where a falling function f, with f(0) > 0 >= f(high), is zero.  Newton's method from `guess`.  Where that would
/// leave the bracket, or does not halve its own step (infinite slopes at zero do both), the bracket is halved by magnitude, so that roots
/// of 1e-200 are found as well.  It ends with the first Newton step below 1e-6 of the root: convergence is quadratic, so what is left is
/// of the order of 1e-12.
template <std::regular_invocable<Real> F>
Real positive_root(F&& f, Real high, Real guess) noexcept
{
  constexpr Real last_step = 1e-6;
  constexpr Real rounding = 1e-15;
  constexpr int enough = 100;                  // bisections of a bracket of one order of magnitude down to rounding take 52
  Real low = 0, down = 1e-2, step = 2 * high;  // a step may go anywhere in the bracket once, then it must halve
  const auto middle = [&] { return low > 0 ? std::sqrt(low) * std::sqrt(high) : high * (down *= down); };
  Real x = guess > 0 && guess <= high ? guess : middle();
  for (int i = 0; i < enough; ++i) {
    const ValueAndSlope at = f(x);
    if (at.value == 0)
      return x;
    (at.value > 0 ? low : high) = x;
    const Real change = -at.value / at.slope, newton = x + change;
    if (std::isfinite(at.slope) && newton > low && newton <= high * (1 + rounding) && std::abs(change) <= 0.5 * step) {
      if (std::abs(change) <= last_step * newton)
        return std::min(newton, high);
      x = newton;
      step = std::abs(change);
    } else {
      x = middle();
      step = 2 * (high - low);
      if (step <= 2 * rounding * high)
        return x;
    }
  }
  return x;
}

}  // namespace talus
