#pragma once
// Common parts of the laws of metals: the elastic trial state in logarithmic strain, and the state with a fraction of its shear.
#include <algorithm>
#include <cmath>
#include <limits>

#include "materials/law.hpp"
#include "materials/logarithm.hpp"

namespace talus {

/// The trial state: the end of a step without plastic flow.  For isotropic laws the radial return of small strain acts on the elastic
/// logarithmic strain itself, and the flow keeps the volume (Simo 1992, CMAME 99, 61).
template <class T>
struct ElasticTrial {
  Sym3Of<T> left;          ///< elastic left Cauchy-Green tensor minus identity
  Sym3Of<T> shear_strain;  ///< deviator of the elastic logarithmic strain
  T volume_strain;         ///< logarithm of the elastic volume ratio
  T shear;                 ///< sqrt(2/3) |shear_strain|, the equivalent strain

  ElasticTrial(const IncrementOf<T>& in, const Sym3Of<T>& elastic_left) noexcept : left(push_forward(in.dt * in.L, elastic_left))
  {
    using std::sqrt;
    const Sym3Of<T> twice_strain = log1p(left);
    volume_strain = 0.5 * trace(twice_strain);
    // A division, not a product with 1/3: the compiler would fuse a product with the sum and leave shear in a pure change of volume.
    shear_strain = scale_and_shift(0.5, twice_strain, -volume_strain / 3);
    shear = sqrt(T(squared_norm(shear_strain) * (2.0 / 3)));
  }
  MaskOf<T> is_finite() const noexcept
  {
    using std::isfinite;
    return isfinite(T(volume_strain + shear));
  }
  /// The elastic left Cauchy-Green tensor minus identity, with the given fraction of the shear strain.
  Sym3Of<T> left_with(const T& remaining) const noexcept
  {
    return expm1(scale_and_shift(2 * remaining, shear_strain, volume_strain * (2.0 / 3)));
  }
};

/// The elastic left Cauchy-Green tensor minus identity for the Kirchhoff stress deviator `s` and a logarithmic volume strain.
inline Sym3 elastic_left_of(const Mat3& s, Real shear_modulus, Real volume_strain) noexcept
{
  return expm1(add_diagonal(pack(s / shear_modulus), 2 * volume_strain / 3));
}

/// The volume at the end of the step over the volume before.
template <class T>
T growth_of(const IncrementOf<T>& in) noexcept
{
  return (Mat3Of<T>::Identity() + in.dt * in.L).determinant();
}

/// A divisor that is positive where `a` may be zero in a lane whose quotient is not used; the bound is far below any strain, stress or
/// fraction.
template <class T>
T above_nothing(const T& a) noexcept
{
  using std::max;
  return max(a, T(1e-200));
}

/// The slope of power hardening with an exponent below 1 at zero plastic strain.
inline constexpr Real infinitely_steep = std::numeric_limits<Real>::infinity();

/// x^n, computed fast near a point where it is known: hardening changes little within a step.
template <class T>
class PowerNear {
 public:
  PowerNear(const T& at, Real exponent) noexcept : at_(at), inverse_(1 / above_nothing(at)), exponent_(exponent), value_(power(at)) {}
  T operator()(const T& x) const noexcept
  {
    using std::abs, std::max;
    // The first terms that the binomial series omits are below 0.001^6 and 0.02^8 for exponents below 1.
    const T r = (x - at_) * inverse_, size = abs(r) * max(exponent_, Real{1});
    const auto same = x == at_;
    if (all_of(same))
      return value_;
    if (all_of(same || size <= 0.001))
      return where(same, value_, value_ * series<5>(r));
    if (all_of(same || size <= 0.02))
      return where(same, value_, value_ * series<7>(r));
    return where(same, value_, power(x));
  }

 private:
  T power(const T& x) const noexcept
  {
    using std::pow;
    const auto some = x > 0;  // metal without plastic strain and heating is common
    return any_of(some) ? where(some, pow(x, exponent_), 0) : T(0);
  }
  /// (1 + r)^n
  template <int terms>
  T series(const T& r) const noexcept
  {
    T sum = 1;
    for (int k = terms; k > 0; --k)
      sum = 1 + sum * (r * (exponent_ - (k - 1)) * (1.0 / k));
    return sum;
  }

  T at_, inverse_;
  Real exponent_;
  T value_;
};

}  // namespace talus
