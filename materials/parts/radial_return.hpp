#pragma once
// Common parts of the laws of metals: the elastic trial state in logarithmic strain, and the state with a fraction of its shear.
#include <algorithm>
#include <cmath>
#include <limits>

#include "materials/parts/law.hpp"
#include "materials/parts/logarithm.hpp"
#include "materials/parts/power_near.hpp"

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

/// The slope of power hardening with an exponent below 1 at zero plastic strain.
inline constexpr Real infinitely_steep = std::numeric_limits<Real>::infinity();

}  // namespace talus
