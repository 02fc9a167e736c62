#pragma once
// Soil and sand: a cone in stress space on logarithmic elasticity, with tension cut-off, dilation and softening.
#include <string>
#include <string_view>

#include "materials/parts/hencky_plastic.hpp"
#include "materials/parts/logarithm.hpp"
#include "materials/parts/softening_length.hpp"

namespace talus {

/// The cone that approximates a Mohr-Coulomb soil: through its corners of triaxial compression (outer) or extension (inner), or with equal
/// strength in plane strain.
enum class ConeMatch : std::uint8_t { outer, inner, plane_strain };
constexpr auto enum_names(ConeMatch) { return std::array<std::string_view, 3>{"outer", "inner", "plane_strain"}; }

/// A cone: yield where tau + q s = k with tau = sqrt(J2) and s = tr/3 (tension positive) of the Kirchhoff stress.
template <class T>
struct ConeOf {
  T q;  ///< slope [-]
  T k;  ///< strength at s = 0 [Pa]
};
using Cone = ConeOf<Real>;

/// Drucker-Prager with non-associated flow (g = tau + q_psi s) in Kirchhoff stress and logarithmic strain, with the return by backward
/// Euler; for isotropic elasticity the return acts on the elastic logarithmic strain itself (Simo 1992, CMAME 99, 61).  The material opens
/// where the mean stress reaches the cut-off or the tip of the cone: the opened volume is stored and must close at zero mean stress before
/// the material is compressed again.  Formulas and numbers: docs/reference/materials.md.
struct DruckerPrager : ConePlastic, SoilStrength {
  static constexpr std::string_view name = "drucker_prager";
  static constexpr std::string_view summary =
      "Drucker-Prager cone on logarithmic elasticity: non-associated, tension cut-off, apex, linear softening (Drucker & Prager 1952).";
  ConeMatch match{};
  static constexpr auto fields()
  {
    using Law = DruckerPrager;
    return std::tuple_cat(
        std::tuple{required<Law, Real>("density", &Law::density, positive, "kg/m^3", "mass density at rest")}, elastic_fields<Law>(),
        std::tuple{required<Law, Real>("friction_angle", &Law::friction_angle, from_to_below(0, 90), "deg",
                                       "angle of friction of the Mohr-Coulomb soil that is matched"),
                   required<Law, Real>("cohesion", &Law::cohesion, non_negative, "Pa", "cohesion of the Mohr-Coulomb soil that is matched"),
                   required_choice(
                       "match", &Law::match,
                       "which strength the cone shares with Mohr-Coulomb: triaxial compression (outer), extension (inner), plane strain")},
        softening_fields<Law>("largest mean stress; without it the tip of the cone",
                              "plastic_strain at which the residual strength is reached, linear before; without it nothing softens"));
  }
  /// Appends the violated rules between parameters.
  void check(std::vector<std::string>& problems) const;
  /// Divides the strength of the matched Mohr-Coulomb soil by a factor.
  void divide_strength(Real factor) noexcept;
  /// The largest mean stress before softening [Pa].
  Real tip_of_strength() const noexcept;

  /// The cone for a friction angle [deg] and a cohesion [Pa] under `match`, with the dilation angle of this law.
  Cone cone_of(Real friction, Real soil_cohesion) const noexcept;
  /// The cone after a plastic strain [-].
  Cone cone(Real plastic_strain) const noexcept;
  /// q_psi, the slope of the plastic potential [-].
  Real dilation_slope() const noexcept;

  /// Quantities that depend on the parameters only: their trigonometry costs more than the rest of an update.
  struct Constants {
    Real bulk, shear;       ///< Pa
    Cone peak, residual;    ///< cones before and after softening
    Cone slope;             ///< change of the cone per plastic strain while it softens
    Real softening_strain;  ///< plastic strain at which softening ends; infinite without softening
    Real q_psi;             ///< slope of the plastic potential [-]
    Real cutoff;            ///< largest mean stress [Pa]; infinite if only the tip of the cone limits it
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
  /// The yield function tau + q s - k [Pa] of the Kirchhoff stress that belongs to the elastic strain of `state`; the Cauchy stress is the
  /// Kirchhoff stress over J.
  Real yield(const Mat3& stress, const State& state) const noexcept { return yield(stress, state, state.plastic_strain); }
  /// The same for the strength at another plastic strain.
  Real yield(const Mat3& stress, const State& state, Real softened_at) const noexcept;

  using Kinds = TypeList<DruckerPrager, WithSofteningLength<DruckerPrager>>;
  using Widest = WithSofteningLength<DruckerPrager>;
  auto kind() const { return kind_by_softening_length(*this); }
};

}  // namespace talus
