#pragma once
// Common parts of plastic laws on logarithmic elasticity: density, initial state of a given stress, wave speeds; and the strength of soils.
#include <optional>
#include <string>
#include <vector>

#include "materials/parts/elasticity.hpp"
#include "materials/parts/law.hpp"

namespace talus {

/// An isotropic law whose Kirchhoff stress is linear in the elastic logarithmic strain, stored in the history as `elastic_left`.  The
/// constants of the law contain the moduli `bulk` and `shear` [Pa].
struct HenckyPlastic : Elasticity {
  Real density{};  ///< kg/m^3 at rest

  /// Sets the elastic strain in the history for which the Kirchhoff stress is `stress` [Pa].
  template <class State>
  void prestress(const Mat3& stress, State& state) const noexcept
  {
    state.elastic_left = elastic_left_under(stress);
  }
  /// The modulus rho_0 c^2 = lambda + 2 mu - (Kirchhoff stress)_nn, with the compression of uniaxial strain of the same volume.
  template <class T, class Constants>
  T wave_speed(const Mat3Of<T>& F, const Constants& c) const noexcept
  {
    return wave_speed_of(F, c.bulk, c.shear);
  }

 private:
  Sym3 elastic_left_under(const Mat3& stress) const noexcept;
  template <class T>
  T wave_speed_of(const Mat3Of<T>& F, Real bulk, Real shear) const noexcept;
};

/// The history of soil that opens under tension: the opened volume is stored, and must close before the material is compressed again.
struct SoilState {
  Sym3 elastic_left = Sym3::Zero();
  Real plastic_strain = 0, plastic_work = 0, opened_volume = 0;
  static constexpr auto fields()
  {
    using State = SoilState;
    return std::tuple{
        history("elastic_left", &State::elastic_left, "-", "elastic left Cauchy-Green tensor minus identity: xx, yy, zz, xy, yz, xz"),
        history("plastic_strain", &State::plastic_strain, "-", "accumulated deviatoric plastic strain, integral of sqrt(2/3 e:e)"),
        history("plastic_work", &State::plastic_work, "J/m^3", "dissipated energy per initial volume"),
        history("opened_volume", &State::opened_volume, "-", "logarithmic volume strain kept open; closes before compression is felt")};
  }
};

/// A Hencky law with flow on a cone, tau + q s = k with tau = sqrt(J2) and s = tr/3 (tension positive) of the Kirchhoff stress.
struct ConePlastic : HenckyPlastic {
  using State = SoilState;
  /// As HenckyPlastic::prestress, but without rounding of the volume strain.
  void prestress(const Mat3& stress, State& state) const noexcept;

 protected:
  /// The yield function tau + q s - k [Pa] of the elastic strain in `state`.
  Real cone_yield(const State& state, Real bulk, Real shear, Real q, Real k) const noexcept;
};

/// The strength of a Mohr-Coulomb soil and its softening: angles in degrees, cohesions and cut-off in Pa.
struct SoilStrength {
  Real friction_angle{}, cohesion{}, dilation_angle = 0;
  std::optional<Real> tension_cutoff, residual_friction_angle, residual_cohesion, softening_strain, softening_length;

  Real softened_friction_angle() const noexcept { return residual_friction_angle.value_or(friction_angle); }
  Real softened_cohesion() const noexcept { return residual_cohesion.value_or(cohesion); }
  /// Appends the contradictions between parameters.
  void check(std::vector<std::string>& problems) const;

 protected:
  /// Divides c and tan(phi) by a factor F, at the peak and after softening: on every plane c + s tan(phi) decreases to 1/F of its value.
  /// The tip of the surface, at the normal stress c / tan(phi), does not move.  The dilation stays as long as it does not exceed the
  /// friction.
  void divide_shear_strength(Real factor) noexcept;
  /// Divides the cut-off by a factor, like a cohesion; for a factor below 1 it is at most the tip.
  void divide_cutoff(Real factor, Real tip) noexcept;
};

/// The fields of dilation, cut-off and softening of a law that inherits SoilStrength.
template <class Law>
constexpr auto softening_fields(std::string_view cutoff_meaning, std::string_view softening_meaning)
{
  using Some = std::optional<Real>;
  return std::tuple{
      optional<Law, Real>("dilation_angle", &Law::dilation_angle, from_to_below(0, 90), "deg",
                          "angle of dilation, at most every angle of friction"),
      optional<Law, Some>("tension_cutoff", &Law::tension_cutoff, non_negative, "Pa", cutoff_meaning),
      optional<Law, Some>("residual_friction_angle", &Law::residual_friction_angle, from_to_below(0, 90), "deg",
                          "angle of friction after softening; without it the friction stays"),
      optional<Law, Some>("residual_cohesion", &Law::residual_cohesion, non_negative, "Pa",
                          "cohesion after softening; without it the cohesion stays"),
      optional<Law, Some>("softening_strain", &Law::softening_strain, positive, "-", softening_meaning),
      optional<Law, Some>("softening_length", &Law::softening_length, positive, "m",
                          "over which the plastic strain is averaged that softens; shear bands are 2 pi times as wide; without "
                          "it their width is that of the cells")};
}

}  // namespace talus
