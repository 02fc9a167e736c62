#pragma once
// Flowing sand: friction that increases with the shear rate, on logarithmic elasticity.
#include <string>
#include <string_view>
#include <vector>

#include "materials/parts/hencky_plastic.hpp"
#include "materials/parts/logarithm.hpp"

namespace talus {

/// Rheology of dense granular flow, tau = mu(I) p with
///     mu(I) = mu_s + (mu_2 - mu_s) / (1 + I_0 / I),    I = g d sqrt(rho_s / p)         [Jop, Forterre & Pouliquen 2006, Nature 441, 727]
/// where g is the rate of plastic shear, as elasto-viscoplasticity on the elastic logarithmic strain.  Flow keeps the volume.  A step is
/// implicit, tau_trial - G dt g = mu(I(g)) p, in closed form (Dunatunga & Kamrin 2015, J. Fluid Mech. 779, 483).  Without pressure the
/// material opens freely; the opened volume is stored and must close before the material is compressed again, as in DruckerPrager.  With
/// mu_2 = mu_s this is a Drucker-Prager cone of slope mu_s without cohesion and dilation.
struct MuI : ConePlastic {
  static constexpr std::string_view name = "mu_i";
  static constexpr std::string_view summary =
      "Dense granular flow with friction mu(I) by inertial number, isochoric, no tension (Jop, Forterre & Pouliquen 2006).";
  Real static_friction{}, limiting_friction{}, inertial_number{}, grain_diameter{}, grain_density{};
  static constexpr auto fields()
  {
    return std::tuple_cat(
        std::tuple{required<MuI, Real>("density", &MuI::density, positive, "kg/m^3", "mass density of grains and voids at rest")},
        elastic_fields<MuI>(),
        std::tuple{
            required("static_friction", &MuI::static_friction, non_negative, "-", "mu_s = tau/p where flow begins, tau = sqrt(J2)"),
            required("limiting_friction", &MuI::limiting_friction, non_negative, "-", "mu_2 of the fastest flow, at least static_friction"),
            required("inertial_number", &MuI::inertial_number, positive, "-", "I_0, at which the friction is half way to mu_2"),
            required("grain_diameter", &MuI::grain_diameter, positive, "m", "d"),
            required("grain_density", &MuI::grain_density, positive, "kg/m^3", "rho_s, mass density of the grains themselves")});
  }
  /// Appends the violated rules between parameters.
  void check(std::vector<std::string>& problems) const;
  /// Divides mu by a factor at every inertial number.
  void divide_strength(Real factor) noexcept
  {
    static_friction /= factor;
    limiting_friction /= factor;
  }

  struct Constants {
    Real bulk, shear;  ///< Pa
    Real rate_scale;   ///< I_0 / (d sqrt(rho_s)): multiplied by sqrt(p) it is the shear rate at which I = I_0
  };
  Constants constants() const noexcept;

  /// The friction coefficient mu of steady flow at an inertial number.
  Real friction(Real inertial) const noexcept;
  template <class T>
  Mat3Of<T> update(const IncrementOf<T>& in, StateOf<T, State>& state, const Constants& c) const noexcept;
  /// The yield function tau - mu_2 p [Pa] of the Kirchhoff stress that belongs to the elastic strain of `state`.  Below mu_2 p the friction
  /// depends on the shear rate.
  Real yield(const Mat3& stress, const State& state) const noexcept;
};

}  // namespace talus
