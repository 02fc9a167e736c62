#pragma once
// The root of one equation with one unknown for any slope of the function, and numbers with derivatives, for return maps.
#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <type_traits>

#include "core/simd.hpp"

namespace talus {

/// The value of a function and its slope at a point.
template <class T>
struct ValueAndSlopeOf {
  T value, slope;
};
using ValueAndSlope = ValueAndSlopeOf<Real>;

/// A number and its derivatives by n unknowns, by the rules of differentiation.
template <class T, std::size_t n = 1>
struct Jet {
  T value;
  std::array<T, n> slope{};

  template <std::convertible_to<T> Number>
  Jet(const Number& constant) noexcept : value(constant)  // NOLINT(google-explicit-constructor): a constant has no slope
  {}
  /// Unknown number k.
  static Jet unknown(const T& at, std::size_t k = 0) noexcept
  {
    Jet a(at);
    a.slope[k] = 1;
    return a;
  }
  /// f(a) from f and its slope at the value of a.
  static Jet chain(const T& f, const T& df, const Jet& a) noexcept
  {
    Jet c(f);
    for (std::size_t k = 0; k < n; ++k)
      c.slope[k] = df * a.slope[k];
    return c;
  }
  friend Jet operator+(const Jet& a, const Jet& b) noexcept
  {
    Jet c(a.value + b.value);
    for (std::size_t k = 0; k < n; ++k)
      c.slope[k] = a.slope[k] + b.slope[k];
    return c;
  }
  friend Jet operator-(const Jet& a) noexcept { return chain(-a.value, -1, a); }
  friend Jet operator-(const Jet& a, const Jet& b) noexcept { return a + (-b); }
  friend Jet operator*(const Jet& a, const Jet& b) noexcept
  {
    Jet c(a.value * b.value);
    for (std::size_t k = 0; k < n; ++k)
      c.slope[k] = a.slope[k] * b.value + a.value * b.slope[k];
    return c;
  }
  friend Jet operator/(const Jet& a, const Jet& b) noexcept
  {
    const T inverse = 1 / b.value;
    Jet c(a.value * inverse);
    for (std::size_t k = 0; k < n; ++k)
      c.slope[k] = (a.slope[k] - c.value * b.slope[k]) * inverse;
    return c;
  }
  friend Jet exp(const Jet& a) noexcept
  {
    using std::exp;
    const T e = exp(a.value);
    return chain(e, e, a);
  }
  friend Jet log(const Jet& a) noexcept
  {
    using std::log;
    return chain(log(a.value), 1 / a.value, a);
  }
  friend Jet sqrt(const Jet& a) noexcept
  {
    using std::sqrt;
    const T root = sqrt(a.value);
    return chain(root, 0.5 / root, a);
  }
  /// The number, or a bound beyond which it does not change.
  friend Jet clamped(const Jet& a, Real low, Real high) noexcept
  {
    using std::max, std::min;
    return chain(min(max(a.value, T(low)), T(high)), where(a.value > low && a.value < high, T(1), T(0)), a);
  }
  friend Jet where(const MaskOf<T>& condition, const Jet& a, const Jet& b) noexcept
  {
    Jet c(where(condition, a.value, b.value));
    for (std::size_t k = 0; k < n; ++k)
      c.slope[k] = where(condition, a.slope[k], b.slope[k]);
    return c;
  }
};

/// The zero in (0, high] of a decreasing function f, with f(0) > 0 >= f(high).  Newton's method from `guess`.  If a step would leave the
/// bracket, or is not at most half of the previous one (both happen with infinite slopes at zero), the bracket is halved by magnitude, so
/// that roots of 1e-200 are found as well.  It ends with the first Newton step below 1e-6 of the root: convergence is quadratic, so the
/// remaining error is of the order of 1e-12.  With SimdReal every lane is a search of its own; f is called again for lanes that have
/// converged, and only the lanes of `looking` have to converge.
template <class T = Real, std::invocable<T> F>
T positive_root(F&& f, std::type_identity_t<T> high, const std::type_identity_t<T>& guess, const MaskOf<T>& looking = T(1) > T(0)) noexcept
{
  using std::abs, std::isfinite, std::min, std::sqrt;
  constexpr Real last_step = 1e-6;
  constexpr Real rounding = 1e-15;
  constexpr int enough = 100;               // bisections of a bracket of one order of magnitude to round-off take 52
  T low = 0, down = 1e-2, step = 2 * high;  // the first step may go anywhere in the bracket, later ones must halve
  const auto middle = [&](const MaskOf<T>& asked) -> T {
    down = where(asked && low <= 0, down * down, down);
    return where(low > 0, sqrt(low) * sqrt(high), high * down);
  };
  T x = guess;
  if (const auto bad = !(guess > 0 && guess <= high); any_of(bad))
    x = where(bad, middle(bad), x);
  T root = x;
  auto open = looking;
  for (int i = 0; i < enough && any_of(open); ++i) {
    const ValueAndSlopeOf<T> at = f(x);
    const auto above = at.value > 0;
    low = where(open && above, x, low);
    high = where(open && !above, x, high);
    const T change = -at.value / at.slope, newton = x + change;
    const auto exact = at.value == 0;
    const auto fine = isfinite(at.slope) && newton > low && newton <= high * (1 + rounding) && abs(change) <= 0.5 * step;
    const auto last = fine && abs(change) <= last_step * newton;
    root = where(open, where(exact, x, where(last, min(newton, high), x)), root);
    open = open && !exact && !last;
    if (!any_of(open))
      break;
    const auto halved = open && !fine;
    T next = newton;
    step = where(open, abs(change), step);
    if (any_of(halved)) {
      next = where(halved, middle(halved), next);
      step = where(halved, 2 * (high - low), step);
      root = where(halved, next, root);
      open = open && !(halved && step <= 2 * rounding * high);
    }
    root = where(open, next, root);
    x = where(open, next, x);
  }
  return root;
}

}  // namespace talus
