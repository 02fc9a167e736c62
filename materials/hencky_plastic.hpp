#pragma once
// What plastic laws on logarithmic elasticity share: density, the state that a given stress stands for, waves; and the strength of soils.
#include <optional>
#include <string>
#include <vector>

#include "materials/elasticity.hpp"
#include "materials/law.hpp"

namespace talus {

/// An isotropic law whose Kirchhoff stress is linear in the elastic logarithmic strain, which its history keeps as `elastic_left`.  The
/// constants of the law hold the moduli `bulk` and `shear` [Pa].
struct HenckyPlastic : Elasticity {
  Real density{};  ///< kg/m^3 at rest

  /// History of the elastic strain under which the Kirchhoff stress is `stress` [Pa].
  template <class State>
  void prestress(const Mat3& stress, State& state) const noexcept
  {
    state.elastic_left = elastic_left_under(stress);
  }
  /// rho_0 c^2 = lambda + 2 mu - (Kirchhoff stress)_nn, the compression taken as that of uniaxial strain with the same volume.
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

/// What soil remembers that opens under tension: the opened volume is kept, and closes before compression is felt again.
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

/// Such a law that flows on a cone, tau + q s = k with tau = sqrt(J2) and s = tr/3 (tension positive) of the Kirchhoff stress.
struct ConePlastic : HenckyPlastic {
  using State = SoilState;
  /// That of HenckyPlastic, but for the rounding of the volume strain.
  void prestress(const Mat3& stress, State& state) const noexcept;

 protected:
  /// tau + q s - k of the elastic strain of `state`.
  Real cone_yield(const State& state, Real bulk, Real shear, Real q, Real k) const noexcept;
};

/// Strength of a Mohr-Coulomb soil and how it softens: angles in degrees, cohesions and cut-off in Pa.
struct SoilStrength {
  Real friction_angle{}, cohesion{}, dilation_angle = 0;
  std::optional<Real> tension_cutoff, residual_friction_angle, residual_cohesion, softening_strain;

  Real softened_friction_angle() const noexcept { return residual_friction_angle.value_or(friction_angle); }
  Real softened_cohesion() const noexcept { return residual_cohesion.value_or(cohesion); }
  /// What contradicts itself, in words.
  void check(std::vector<std::string>& problems) const;

 protected:
  /// c / F and tan(phi) / F, at the peak and after softening: on every plane c + s tan(phi) falls to its F-th part.  The tip of the
  /// surface stays where it is, at c / tan(phi) by its normal stress.  So does the dilation, as far as friction is left to dilate with.
  void divide_shear_strength(Real factor) noexcept;
  /// The cut-off falls like a cohesion, and ends at the tip where a factor below 1 lifts it there.
  void divide_cutoff(Real factor, Real tip) noexcept;
};

/// The fields of dilation, cut-off and softening of a law that inherits SoilStrength.
template <class Law>
constexpr auto softening_fields(std::string_view cutoff_meaning, std::string_view softening_meaning)
{
  using Some = std::optional<Real>;
  return std::tuple{optional<Law, Real>("dilation_angle", &Law::dilation_angle, from_to_below(0, 90), "deg",
                                        "angle of dilation, at most every angle of friction"),
                    optional<Law, Some>("tension_cutoff", &Law::tension_cutoff, non_negative, "Pa", cutoff_meaning),
                    optional<Law, Some>("residual_friction_angle", &Law::residual_friction_angle, from_to_below(0, 90), "deg",
                                        "angle of friction after softening; without it the friction stays"),
                    optional<Law, Some>("residual_cohesion", &Law::residual_cohesion, non_negative, "Pa",
                                        "cohesion after softening; without it the cohesion stays"),
                    optional<Law, Some>("softening_strain", &Law::softening_strain, positive, "-", softening_meaning)};
}

}  // namespace talus
