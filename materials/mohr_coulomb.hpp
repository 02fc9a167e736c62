#pragma once
// Soil and rock by the angle of friction itself: the six planes of Mohr and Coulomb on top of logarithmic elasticity.
#include <optional>
#include <string>
#include <string_view>

#include "materials/elasticity.hpp"
#include "materials/law.hpp"

namespace talus {

/// Yield where (s1 - s3)/2 + sine (s1 + s3)/2 = cohesive, s1 the largest and s3 the smallest principal Kirchhoff stress, tension positive.
struct ShearStrength {
  Real sine;      ///< of the angle of friction [-]
  Real cohesive;  ///< cohesion times cosine of the angle of friction [Pa]
};

/// Mohr-Coulomb with non-associated flow (the same form with the angle of dilation) and a Rankine limit of tension, in Kirchhoff stress and
/// logarithmic strain.  The return is backward Euler, exact: to a plane, an edge, a corner or the apex in principal stresses (Clausen,
/// Damkilde & Andersen 2006, IJNME 66, 1831; de Souza Neto, Peric & Owen 2008, ch. 8); isotropy makes it act on the elastic logarithmic
/// strain itself (Simo 1992, CMAME 99, 61).  Material that all three principal stresses pull open keeps the opened volume, which closes at
/// zero mean stress before compression is felt again; a crack across one direction alone is not kept.
struct MohrCoulomb : Elasticity {
  static constexpr std::string_view name = "mohr_coulomb";
  static constexpr std::string_view summary =
      "Mohr-Coulomb planes on logarithmic elasticity: non-associated, exact edges and apex, Rankine tension cut-off, linear softening "
      "(Coulomb 1773; Clausen et al. 2006).";
  Real density{}, friction_angle{}, cohesion{};
  Real dilation_angle = 0;
  std::optional<Real> tension_cutoff, residual_friction_angle, residual_cohesion, softening_strain;
  static constexpr auto fields()
  {
    using Law = MohrCoulomb;
    return std::tuple_cat(
        std::tuple{required("density", &Law::density, positive, "kg/m^3", "mass density at rest")}, elastic_fields<Law>(),
        std::tuple{
            required("friction_angle", &Law::friction_angle, from_to_below(0, 90), "deg", "angle of friction"),
            required("cohesion", &Law::cohesion, non_negative, "Pa", "cohesion"),
            optional("dilation_angle", &Law::dilation_angle, from_to_below(0, 90), "deg",
                     "angle of dilation, at most every angle of friction"),
            optional("tension_cutoff", &Law::tension_cutoff, non_negative, "Pa",
                     "largest principal stress (Rankine); without it the apex of the planes"),
            optional("residual_friction_angle", &Law::residual_friction_angle, from_to_below(0, 90), "deg",
                     "angle of friction after softening; without it the friction stays"),
            optional("residual_cohesion", &Law::residual_cohesion, non_negative, "Pa",
                     "cohesion after softening; without it the cohesion stays"),
            optional(
                "softening_strain", &Law::softening_strain, positive, "-",
                "plastic_strain at which the residual strength is reached; sin(phi) and c cos(phi) go linearly before; without it nothing "
                "softens")});
  }
  /// Rules between parameters.
  void check(std::vector<std::string>& problems) const;
  void divide_strength(Real factor) noexcept;
  /// The apex before anything softens [Pa].
  Real tip_of_strength() const noexcept;

  struct State {
    Sym3 elastic_left = Sym3::Zero();
    Real plastic_strain = 0, plastic_work = 0, opened_volume = 0;
    static constexpr auto fields()
    {
      return std::tuple{
          history("elastic_left", &State::elastic_left, "-", "elastic left Cauchy-Green tensor minus identity: xx, yy, zz, xy, yz, xz"),
          history("plastic_strain", &State::plastic_strain, "-", "accumulated deviatoric plastic strain, integral of sqrt(2/3 e:e)"),
          history("plastic_work", &State::plastic_work, "J/m^3", "dissipated energy per initial volume"),
          history("opened_volume", &State::opened_volume, "-", "logarithmic volume strain kept open; closes before compression is felt")};
    }
  };

  /// What follows from the parameters alone.
  struct Constants {
    Real bulk, shear;              ///< Pa
    ShearStrength peak, residual;  ///< before and after softening
    ShearStrength slope;           ///< of the strength by plastic strain while it softens
    Real softening_strain;         ///< infinite if nothing softens
    Real sin_psi;                  ///< sine of the angle of dilation
    Real cutoff;                   ///< Pa, infinite if there is only the apex
    ShearStrength strength_at(Real plastic_strain) const noexcept
    {
      return plastic_strain < softening_strain
                 ? ShearStrength{peak.sine + plastic_strain * slope.sine, peak.cohesive + plastic_strain * slope.cohesive}
                 : residual;
    }
  };
  Constants constants() const noexcept;

  Mat3 update(const Increment& in, State& state, const Constants& c) const noexcept;
  void prestress(const Mat3& stress, State& state) const noexcept;
  /// The larger of (s1 - s3)/2 + sine (s1 + s3)/2 - cohesive and s1 - tension_cutoff, of the Kirchhoff stress that belongs to the elastic
  /// strain of `state`; the Cauchy stress is that over J.
  Real yield(const Mat3& stress, const State& state) const noexcept;
  /// rho_0 c^2 = lambda + 2 mu - (Kirchhoff stress)_nn, the compression taken as that of uniaxial strain with the same volume.
  Real wave_speed(const Mat3& F, const Constants& c) const noexcept;
};

}  // namespace talus
