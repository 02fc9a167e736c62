#pragma once
// Powers with a fixed exponent, fast near a point where the power is known: hardening changes little within a step.
#include <array>
#include <cmath>

#include "core/simd.hpp"

namespace talus {

/// A divisor that is positive where `a` may be zero in a lane whose quotient is not used; the bound is far below any strain, stress or
/// fraction.
template <class T>
T above_nothing(const T& a) noexcept
{
  using std::max;
  return max(a, T(1e-200));
}

/// (1 + r)^n as a series in r, with coefficients that are worked out once per body.
class BinomialSeries {
 public:
  static constexpr int most_terms = 14;
  BinomialSeries(Real exponent) noexcept : exponent_(exponent)  // NOLINT(google-explicit-constructor): the exponent is all there is to it
  {
    coefficients_[0] = 1;
    for (std::size_t k = 1; k < coefficients_.size(); ++k)
      coefficients_[k] = coefficients_[k - 1] * (exponent - static_cast<Real>(k - 1)) / static_cast<Real>(k);
  }
  Real exponent() const noexcept { return exponent_; }
  /// The series up to r^terms.  Even and odd powers are two chains, which the processor computes side by side.
  template <int terms, class T>
  T sum(const T& r) const noexcept
  {
    static_assert(terms >= 2 && terms <= most_terms);
    constexpr std::size_t last_even = terms / 2 * 2, last_odd = (terms - 1) / 2 * 2 + 1;
    const T r2 = r * r;
    T even = coefficients_[last_even], odd = coefficients_[last_odd];
    for (std::size_t k = last_even; k >= 2; k -= 2)
      even = coefficients_[k - 2] + even * r2;
    for (std::size_t k = last_odd; k >= 2; k -= 2)
      odd = coefficients_[k - 2] + odd * r2;
    return even + odd * r;
  }

 private:
  Real exponent_;
  std::array<Real, most_terms + 1> coefficients_{};
};

/// x^n, computed fast near a point where it is known.
template <class T>
class PowerNear {
 public:
  PowerNear(const T& at, const BinomialSeries& binomial) noexcept : binomial_(binomial) { begin_at(at); }
  T operator()(const T& x) const noexcept
  {
    const T r = (x - at_) * inverse_, size = size_of(r);
    return all_of(size <= far) ? near(r, size) : power(x);
  }
  /// The same, and a power that was computed in full becomes the known one: the steps of an iteration become small.
  T advance(const T& x) noexcept
  {
    const T r = (x - at_) * inverse_, size = size_of(r);
    if (all_of(size <= far))
      return near(r, size);
    begin_at(x);
    return value_;
  }

 private:
  static constexpr Real far = 0.1;

  void begin_at(const T& x) noexcept { at_ = x, inverse_ = 1 / above_nothing(x), value_ = power(x); }
  T size_of(const T& r) const noexcept
  {
    using std::abs;
    return abs(r) * std::max(binomial_.exponent(), Real{1});
  }
  T near(const T& r, const T& size) const noexcept
  {
    // The first terms that the series omits are below 0.001^6, 0.02^8 and 0.1^15 times a coefficient that is below 0.03 for exponents
    // below 1.  The known point is met exactly, also where it is zero.
    if (all_of(size <= 0.001))
      return value_ * binomial_.sum<5>(r);
    if (all_of(size <= 0.02))
      return value_ * binomial_.sum<7>(r);
    return value_ * binomial_.sum<BinomialSeries::most_terms>(r);
  }
  T power(const T& x) const noexcept
  {
    using std::pow;
    const auto some = x > 0;  // metal without plastic strain and heating is common
    return any_of(some) ? where(some, pow(x, binomial_.exponent()), 0) : T(0);
  }

  BinomialSeries binomial_;
  T at_, inverse_, value_;
};

}  // namespace talus
