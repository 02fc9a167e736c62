#pragma once
// Root of one equation with one unknown, found whatever the slope does: for return maps.
#include <cmath>
#include <concepts>

#include "core/types.hpp"

namespace talus {

/// A function at a point.
struct ValueAndSlope {
  Real value, slope;
};

namespace detail {
/// Halves a bracket of positive numbers by magnitude, so that a root of 1e-20 below 1 is found in a few steps as well.
inline Real between_by_magnitude(Real low, Real high) noexcept
{
  constexpr Real down = 1e-4;
  return low > 0 ? std::sqrt(low) * std::sqrt(high) : down * high;
}
}  // namespace detail

/// The x in (0, high] where a falling function f, with f(0) > 0 >= f(high), is zero.  Newton's method from `guess`; by magnitude where
/// that would leave the bracket, or does not halve its own step (infinite slopes at zero do both).  It ends with the first Newton
/// step below 1e-6 of the root: convergence is quadratic, so what is left is of the order of 1e-12.
template <std::regular_invocable<Real> F>
Real positive_root(F&& f, Real high, Real guess) noexcept
{
  constexpr Real last_step = 1e-6;
  constexpr int enough = 100;  // bisections from 1 to 1e-300 and down to rounding take 90
  Real low = 0, x = guess > 0 && guess <= high ? guess : detail::between_by_magnitude(low, high), step = high;
  for (int i = 0; i < enough; ++i) {
    const ValueAndSlope at = f(x);
    if (at.value == 0)
      return x;
    (at.value > 0 ? low : high) = x;
    const Real change = -at.value / at.slope, newton = x + change;
    if (std::isfinite(at.slope) && newton > low && newton <= high && std::abs(change) <= 0.5 * step) {
      if (std::abs(change) <= last_step * newton)
        return newton;
      x = newton;
      step = std::abs(change);
    } else {
      x = detail::between_by_magnitude(low, high);
      step = high - low;
    }
  }
  return x;
}

}  // namespace talus
