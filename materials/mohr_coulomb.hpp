#pragma once
// Soil and rock with a friction angle: the six planes of Mohr and Coulomb on logarithmic elasticity.
#include <string>
#include <string_view>

#include "materials/parts/hencky_plastic.hpp"
#include "materials/parts/softening_length.hpp"

namespace talus {

/// A strength: yield where (s1 - s3)/2 + sine (s1 + s3)/2 = cohesive, with the largest and smallest principal Kirchhoff stress s1 and s3,
/// tension positive.
template <class T>
struct ShearStrengthOf {
  T sine;      ///< sine of the angle of friction [-]
  T cohesive;  ///< cohesion times cosine of the angle of friction [Pa]
};
using ShearStrength = ShearStrengthOf<Real>;

/// Mohr-Coulomb with non-associated flow (of the same form with the angle of dilation) and a Rankine limit of tension, in Kirchhoff stress
/// and logarithmic strain.  The return is backward Euler, exact: to a plane, an edge, a corner or the apex in principal stresses (Clausen,
/// Damkilde & Andersen 2006, IJNME 66, 1831; de Souza Neto, Peric & Owen 2008, ch. 8); for isotropic elasticity it acts on the elastic
/// logarithmic strain itself (Simo 1992, CMAME 99, 61).  If the material opens in all three principal directions, the opened volume is
/// stored and must close at zero mean stress before the material is compressed again; a crack across one direction only is not stored.
struct MohrCoulomb : HenckyPlastic, SoilStrength {
  static constexpr std::string_view name = "mohr_coulomb";
  static constexpr std::string_view summary =
      "Mohr-Coulomb planes on logarithmic elasticity: non-associated, exact edges and apex, Rankine tension cut-off, linear softening "
      "(Coulomb 1773; Clausen et al. 2006).";
  static constexpr auto fields()
  {
    using Law = MohrCoulomb;
    return std::tuple_cat(
        std::tuple{required<Law, Real>("density", &Law::density, positive, "kg/m^3", "mass density at rest")}, elastic_fields<Law>(),
        std::tuple{required<Law, Real>("friction_angle", &Law::friction_angle, from_to_below(0, 90), "deg", "angle of friction"),
                   required<Law, Real>("cohesion", &Law::cohesion, non_negative, "Pa", "cohesion")},
        softening_fields<Law>(
            "largest principal stress (Rankine); without it the apex of the planes",
            "plastic_strain at which the residual strength is reached; sin(phi) and c cos(phi) go linearly before; without it "
            "nothing softens"));
  }
  /// Appends the violated rules between parameters.
  void check(std::vector<std::string>& problems) const;
  void divide_strength(Real factor) noexcept;
  /// The mean stress of the apex before softening [Pa].
  Real tip_of_strength() const noexcept;

  using State = SoilState;

  /// Quantities that depend on the parameters only.
  struct Constants {
    Real bulk, shear;              ///< Pa
    ShearStrength peak, residual;  ///< strength before and after softening
    ShearStrength slope;           ///< change of the strength per plastic strain while it softens
    Real softening_strain;         ///< plastic strain at which softening ends; infinite without softening
    Real sin_psi;                  ///< sine of the angle of dilation [-]
    Real cutoff;                   ///< largest principal stress [Pa]; infinite if only the apex limits it
    template <class T>
    ShearStrengthOf<T> strength_at(const T& plastic_strain) const noexcept
    {
      const auto softens = plastic_strain < softening_strain;
      return {where(softens, peak.sine + plastic_strain * slope.sine, residual.sine),
              where(softens, peak.cohesive + plastic_strain * slope.cohesive, residual.cohesive)};
    }
  };
  Constants constants() const noexcept;

  template <class T>
  Mat3Of<T> update(const IncrementOf<T>& in, StateOf<T, State>& state, const Constants& c) const noexcept;
  /// The yield function [Pa]: the larger of (s1 - s3)/2 + sine (s1 + s3)/2 - cohesive and s1 - tension_cutoff, for the Kirchhoff stress
  /// that belongs to the elastic strain of `state`; the Cauchy stress is the Kirchhoff stress over J.
  Real yield(const Mat3& stress, const State& state) const noexcept { return yield(stress, state, state.plastic_strain); }
  /// The same for the strength at another plastic strain.
  Real yield(const Mat3& stress, const State& state, Real softened_at) const noexcept;

  using Kinds = TypeList<MohrCoulomb, WithSofteningLength<MohrCoulomb>>;
  using Widest = WithSofteningLength<MohrCoulomb>;
  auto kind() const { return kind_by_softening_length(*this); }
};

}  // namespace talus
