#pragma once
// What laws of metals share: the elastic trial state in logarithmic strain, and the state with part of its shear.
#include <algorithm>
#include <cmath>

#include "materials/law.hpp"
#include "materials/logarithm.hpp"

namespace talus {

/// The state at the end of a step as if nothing flowed.  Isotropy makes the radial return of small strain act on the elastic logarithmic
/// strain itself, and the flow keeps the volume (Simo 1992, CMAME 99, 61).
struct ElasticTrial {
  Sym3 left;           ///< elastic left Cauchy-Green tensor minus identity
  Sym3 shear_strain;   ///< deviator of the elastic logarithmic strain
  Real volume_strain;  ///< logarithm of the elastic volume ratio
  Real shear;          ///< sqrt(2/3) |shear_strain|, the equivalent strain

  ElasticTrial(const Increment& in, const Sym3& elastic_left) noexcept : left(push_forward(in.dt * in.L, elastic_left))
  {
    const Sym3 twice_strain = log1p(left);
    volume_strain = 0.5 * trace(twice_strain);
    shear_strain = scale_and_shift(0.5, twice_strain, -volume_strain / 3);
    shear = std::sqrt(squared_norm(shear_strain) * (2.0 / 3));
  }
  bool is_finite() const noexcept { return std::isfinite(volume_strain + shear); }
  /// Elastic left Cauchy-Green tensor minus identity with the share `kept` of the shear strain.
  Sym3 left_with(Real kept) const noexcept { return expm1(scale_and_shift(2 * kept, shear_strain, 2 * volume_strain / 3)); }
};

/// Elastic left Cauchy-Green tensor minus identity that belongs to the Kirchhoff stress deviator `s` and a logarithmic volume strain.
inline Sym3 elastic_left_of(const Mat3& s, Real shear_modulus, Real volume_strain) noexcept
{
  return expm1(add_diagonal(pack(s / shear_modulus), 2 * volume_strain / 3));
}

/// Volume at the end of the step over that before.
inline Real growth_of(const Increment& in) noexcept { return (Mat3::Identity() + in.dt * in.L).determinant(); }

/// x^n, found fast where x is near a point at which it is known: hardening changes little within a step.
class PowerNear {
 public:
  PowerNear(Real at, Real exponent) noexcept : at_(at), inverse_(1 / at), exponent_(exponent), value_(at > 0 ? std::pow(at, exponent) : 0)
  {}
  Real operator()(Real x) const noexcept
  {
    // The first terms that the binomial series leave out are below 0.001^6 and 0.02^8 for exponents below 1.
    const Real r = (x - at_) * inverse_, size = std::abs(r) * std::max(exponent_, Real{1});
    if (r == 0)
      return value_;
    if (size <= 0.001)
      return value_ * series<5>(r);
    if (size <= 0.02)
      return value_ * series<7>(r);
    return std::pow(x, exponent_);
  }

 private:
  /// (1 + r)^n
  template <int terms>
  Real series(Real r) const noexcept
  {
    Real sum = 1;
    for (int k = terms; k > 0; --k)
      sum = 1 + sum * (r * (exponent_ - (k - 1)) * (1.0 / k));
    return sum;
  }

  Real at_, inverse_, exponent_, value_;
};

}  // namespace talus
