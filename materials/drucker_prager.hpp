#pragma once
// Soil and sand: a cone in stress space on top of logarithmic elasticity, with tension cut-off, dilation and softening.
#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

#include "materials/elasticity.hpp"
#include "materials/law.hpp"
#include "materials/logarithm.hpp"

namespace talus {

/// Which cone stands for a Mohr-Coulomb soil: through its corners of triaxial compression (outer) or extension (inner), or with
/// its strength in plane strain.
enum class ConeMatch : std::uint8_t { outer, inner, plane_strain };
constexpr auto enum_names(ConeMatch) { return std::array<std::string_view, 3>{"outer", "inner", "plane_strain"}; }

/// Yield where tau + q s = k with tau = sqrt(J2) and s = tr/3 (tension positive) of the Kirchhoff stress.
template <class T>
struct ConeOf {
  T q;  ///< slope [-]
  T k;  ///< strength at s = 0 [Pa]
};
using Cone = ConeOf<Real>;

/// Drucker-Prager with non-associated flow (g = tau + q_psi s) in Kirchhoff stress and logarithmic strain, return by backward Euler;
/// isotropy makes the return act on the elastic logarithmic strain itself (Simo 1992, CMAME 99, 61).  The material opens where the
/// mean stress reaches the cut-off or the tip of the cone: the opened volume is kept, and closes at zero mean stress before
/// compression is felt again.  Formulas and numbers: docs/reference/materials.md.
struct DruckerPrager : Elasticity {
  static constexpr std::string_view name = "drucker_prager";
  static constexpr std::string_view summary =
      "Drucker-Prager cone on logarithmic elasticity: non-associated, tension cut-off, apex, linear softening (Drucker & Prager 1952).";
  Real density{}, friction_angle{}, cohesion{};
  ConeMatch match{};
  Real dilation_angle = 0;
  std::optional<Real> tension_cutoff, residual_friction_angle, residual_cohesion, softening_strain;
  static constexpr auto fields()
  {
    using Law = DruckerPrager;
    return std::tuple_cat(
        std::tuple{required("density", &Law::density, positive, "kg/m^3", "mass density at rest")}, elastic_fields<Law>(),
        std::tuple{
            required("friction_angle", &Law::friction_angle, from_to_below(0, 90), "deg",
                     "angle of friction of the Mohr-Coulomb soil that is matched"),
            required("cohesion", &Law::cohesion, non_negative, "Pa", "cohesion of the Mohr-Coulomb soil that is matched"),
            required_choice(
                "match", &Law::match,
                "which strength the cone shares with Mohr-Coulomb: triaxial compression (outer), extension (inner), plane strain"),
            optional("dilation_angle", &Law::dilation_angle, from_to_below(0, 90), "deg",
                     "angle of dilation, at most every angle of friction"),
            optional("tension_cutoff", &Law::tension_cutoff, non_negative, "Pa", "largest mean stress; without it the tip of the cone"),
            optional("residual_friction_angle", &Law::residual_friction_angle, from_to_below(0, 90), "deg",
                     "angle of friction after softening; without it the friction stays"),
            optional("residual_cohesion", &Law::residual_cohesion, non_negative, "Pa",
                     "cohesion after softening; without it the cohesion stays"),
            optional("softening_strain", &Law::softening_strain, positive, "-",
                     "plastic_strain at which the residual strength is reached, linear before; without it nothing softens")});
  }
  /// Rules between parameters.
  void check(std::vector<std::string>& problems) const;
  /// That of the Mohr-Coulomb soil that is matched.
  void divide_strength(Real factor) noexcept;
  /// Largest mean stress before anything softens [Pa].
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

  /// Cone of a friction angle [deg] and a cohesion [Pa] under `match`, for the dilation angle of this law.
  Cone cone_of(Real friction, Real soil_cohesion) const noexcept;
  /// Cone after a plastic strain [-].
  Cone cone(Real plastic_strain) const noexcept;
  /// q_psi, the slope of the plastic potential [-].
  Real dilation_slope() const noexcept;

  /// What follows from the parameters alone: trigonometry that costs more than the rest of an update.
  struct Constants {
    Real bulk, shear;       ///< Pa
    Cone peak, residual;    ///< before and after softening
    Cone slope;             ///< of the cone by plastic strain while it softens
    Real softening_strain;  ///< infinite if nothing softens
    Real q_psi;             ///< slope of the plastic potential [-]
    Real cutoff;            ///< Pa, infinite if there is only the tip of the cone
    template <class T>
    ConeOf<T> cone_at(const T& plastic_strain) const noexcept
    {
      const auto softens = plastic_strain < softening_strain;
      return {where(softens, peak.q + plastic_strain * slope.q, residual.q), where(softens, peak.k + plastic_strain * slope.k, residual.k)};
    }
  };
  Constants constants() const noexcept;

  template <class T>
  Mat3Of<T> update(const IncrementOf<T>& in, StateOf<T, State>& state, const Constants& c) const noexcept;
  void prestress(const Mat3& stress, State& state) const noexcept;
  /// tau + q s - k of the Kirchhoff stress that belongs to the elastic strain of `state`; the Cauchy stress is that over J.
  Real yield(const Mat3& stress, const State& state) const noexcept;
  /// rho_0 c^2 = lambda + 2 mu - (Kirchhoff stress)_nn, the compression taken as that of uniaxial strain with the same volume.
  template <class T>
  T wave_speed(const Mat3Of<T>& F, const Constants& c) const noexcept;
};

}  // namespace talus
