#pragma once
// Porous material with cohesion, such as snow, chalk and cemented soil: Cam clay whose ellipse reaches into tension.
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "materials/cam_clay.hpp"
#include "materials/parts/elasticity.hpp"

namespace talus {

/// Cohesive Cam clay (Gaume, Gast, Teran, van Herwijnen & Jiang 2018, "Dynamic anticrack propagation in snow", Nature Communications 9,
/// 3047) in Kirchhoff stress and logarithmic strain.  With p and q as in ModifiedCamClay and a the plastic compaction,
///     yield       (1 + 2 beta) q^2 + M^2 (p + beta p0) (p - p0) = 0, associated
///     elasticity  p = -K e, or that of modified_cam_clay; shear modulus constant
///     hardening   p0 = K sinh(xi max(a, 0)), or that of modified_cam_clay.
/// Compaction hardens and dilation softens, down to p0 = 0 where the hyperbolic sine has lost all the compaction that it started from: then
/// the material is free of stress, and what it opens further is stored and must close before it is compressed again.  It also falls apart
/// where its elastic extension is more than the compaction that is left: on the softening side no stress in between is in equilibrium with
/// its strain.  Exponential hardening never ends; only without cohesion the material opens as in modified_cam_clay.
///
/// The paper returns to the ellipse of the old p0, then hardens; here p0 is that of the end of the step, as the flow is (backward Euler).
struct CohesiveCamClay : CamClay, Elasticity {
  static constexpr std::string_view name = "cohesive_cam_clay";
  static constexpr std::string_view summary =
      "Cam clay with cohesion, for snow and cemented soil: linear or exponential elasticity, hardening by a hyperbolic sine or exponential "
      "(Gaume et al. 2018; Roscoe & Burland 1968).";
  Real critical_state_slope{}, cohesion_ratio{}, preconsolidation_pressure{};
  std::optional<Real> hardening_factor, compression_index, swelling_index, reference_pressure;
  static constexpr auto fields()
  {
    using Law = CohesiveCamClay;
    return std::tuple_cat(
        std::tuple{required<Law, Real>("density", &Law::density, positive, "kg/m^3", "mass density at rest")}, elastic_fields<Law>(),
        std::tuple{required("critical_state_slope", &Law::critical_state_slope, between(0, 3), "-",
                            "M, of the ellipse: its largest q is M (1 + beta) p0 / (2 sqrt(1 + 2 beta))"),
                   required("cohesion_ratio", &Law::cohesion_ratio, non_negative, "-",
                            "beta, strength in isotropic tension over p0, at most 1; 0: none, as in modified_cam_clay"),
                   required("preconsolidation_pressure", &Law::preconsolidation_pressure, positive, "Pa",
                            "p0 at the start, pressure of first yield in isotropic compression; a prestress outside the ellipse raises it"),
                   optional("hardening_factor", &Law::hardening_factor, positive, "-",
                            "xi of p0 = K sinh(xi a), a the plastic compaction; this or compression_index"),
                   optional("compression_index", &Law::compression_index, positive, "-",
                            "lambda of exponential hardening, as in modified_cam_clay; with swelling_index, and above it"),
                   optional("swelling_index", &Law::swelling_index, positive, "-",
                            "kappa of exponential elasticity, as in modified_cam_clay; with shear_modulus and reference_pressure alone"),
                   optional("reference_pressure", &Law::reference_pressure, positive, "Pa",
                            "swelling_index times the bulk modulus at zero pressure; with swelling_index")});
  }
  /// Appends the violated rules between parameters.
  void check(std::vector<std::string>& problems) const;
  /// As ModifiedCamClay::divide_strength: p0 and the strength in isotropic tension stay.
  void divide_strength(Real factor) noexcept { critical_state_slope = slope_over(critical_state_slope, factor); }

  /// q / p in the middle of the ellipse, where shear goes on without change; above M, as beta moves the ellipse towards tension.
  Real critical_slope() const noexcept
  {
    return critical_state_slope * (1 + cohesion_ratio) / ((1 - cohesion_ratio) * std::sqrt(1 + 2 * cohesion_ratio));
  }

  Constants constants() const noexcept;
  void prestress(const Mat3& stress, State& state) const noexcept { start_under(stress, state, constants()); }
  Real yield(const Mat3&, const State& state) const noexcept { return yield_of(state, constants()); }
};

}  // namespace talus
