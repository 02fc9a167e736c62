#pragma once
// Pressure of strongly compressed solids, their internal energy and the speed of sound in them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>

#include "core/fields.hpp"
#include "core/simd.hpp"
#include "materials/parts/law.hpp"

namespace talus {

/// Pressure from compression and internal energy, relative to the Hugoniot with shock speed = c0 + s (particle speed).  With e = 1 - V/V0
/// and the internal energy E per initial volume
///     p = rho0 c0^2 e (1 - gamma e / 2) / (1 - s e)^2 + gamma E    in compression,
///     p = rho0 c0^2 (V0/V - 1) + gamma E                           in tension.       [Meyers 1994, ch. 5]
/// Beyond 90 % of the pole e = 1/s the cold part is continued along its tangent.
struct MieGruneisen {
  Real c0{}, s{}, gamma{};
  static constexpr auto fields()
  {
    return std::tuple{required("c0", &MieGruneisen::c0, positive, "m/s", "speed of a weak shock: the bulk modulus at rest is density c0^2"),
                      required("s", &MieGruneisen::s, non_negative, "-",
                               "gain of shock speed by particle speed; the curve is straight beyond 90 % of the compression 1/s"),
                      required("gamma", &MieGruneisen::gamma, non_negative, "-", "Grueneisen parameter, pressure by energy density")};
  }
};

/// The curve together with its density.
struct MieGruneisenCurve {
  Real bulk;  ///< rho0 c0^2 [Pa]
  Real s, gamma;
  Real straight;                           ///< compression at which the tangent begins
  Real straight_pressure, straight_slope;  ///< pressure and slope there [Pa]

  MieGruneisenCurve(const MieGruneisen& solid, Real density) noexcept
      : bulk(density * solid.c0 * solid.c0), s(solid.s), gamma(solid.gamma), straight(0.9 / s)
  {
    const Real margin = 1 - s * straight;
    straight_pressure = bulk * straight * (1 - 0.5 * gamma * straight) / (margin * margin);
    straight_slope = bulk * (1 + (s - gamma) * straight) / (margin * margin * margin);
  }

  /// The pressure without internal energy [Pa] at the compression e = 1 - V/V0.
  template <class T = Real>
  T cold_pressure(const std::type_identity_t<T>& e) const noexcept
  {
    const T margin = 1 - s * e;
    const T compressed =
        where(e > straight, straight_pressure + straight_slope * (e - straight), bulk * e * (1 - 0.5 * gamma * e) / (margin * margin));
    return where(e < 0, bulk * e / (1 - e), compressed);
  }
  /// The compression with a given cold pressure [Pa] on the curved part; NaN for tension beyond -bulk, which no volume has.
  Real compression_at(Real pressure) const noexcept
  {
    if (pressure < 0)
      return pressure > -bulk ? pressure / (bulk + pressure) : std::numeric_limits<Real>::quiet_NaN();
    const Real b = bulk + 2 * s * pressure, discriminant = bulk * (bulk + 2 * pressure * (2 * s - gamma));
    return 2 * pressure / (b + std::sqrt(discriminant));
  }
  /// An upper bound of dp/de along the isentrope [Pa] through a state on the Hugoniot or below it.
  template <class T = Real>
  T stiffness(const std::type_identity_t<T>& e) const noexcept
  {
    using std::max, std::min;
    const T at = min(max(e, T(0)), T(straight)), margin = 1 - s * at;
    return bulk * (1 + s * at) / (margin * margin * margin);
  }
};

/// The internal energy of one step by the trapezoidal rule, which makes it linear in the pressure at the end.
template <class T>
struct EnergyStep {
  T volume_change;  ///< change per initial volume
  T rest;           ///< energy at the end without the work of the pressure at the end [J/m^3]

  /// The elastic shear energy is known from the Kirchhoff stress `mises`, mises^2 / (6 G); the plastic work is the dissipated part.
  EnergyStep(const IncrementOf<T>& in, const T& change, const T& energy_before, const T& mises_before, const T& mises,
             const T& plastic_work, Real shear) noexcept
      : volume_change(change)
  {
    const T stored = (mises - mises_before) * (mises + mises_before) / (6 * shear);
    rest = energy_before + stored + plastic_work + (in.stress.trace() / 6 - in.viscous) * volume_change;
  }
  T energy(const T& pressure) const noexcept { return rest - 0.5 * pressure * volume_change; }
  /// The pressure at the end.  A step that compresses by more than 1/gamma is not resolved; its pressure stays finite.
  T pressure(const MieGruneisenCurve& curve, const T& compression) const noexcept
  {
    using std::max;
    return (curve.cold_pressure<T>(compression) + curve.gamma * rest) / max(T(1 + 0.5 * curve.gamma * volume_change), T(0.5));
  }
};

/// The modulus rho_0 c^2 = J^2 dp/de + 4 G / 3 - (Kirchhoff deviator)_nn along the direction n of compression, with the deviator of
/// uniaxial strain of the same volume.  The deviator changes the energy as well, hence the factor 1 + gamma.  Without an equation of state
/// the modulus is that of Drucker-Prager.
template <class T>
T wave_modulus(const std::type_identity_t<T>& J, Real bulk, Real shear, const std::optional<MieGruneisenCurve>& curve) noexcept
{
  using std::log, std::max, std::min;
  const T shortening = max(T(-log(J)), T(0));
  const Real deviator = 4 * shear / 3;
  if (!curve)
    return (bulk + deviator) * (1 + shortening);
  const T volume = min(J, T(1));
  return volume * volume * curve->stiffness<T>(1 - J) + deviator * (1 + (1 + curve->gamma) * shortening);
}

}  // namespace talus
