#pragma once
// Clay that hardens by compaction: the ellipse of Cam clay on elasticity with an exponential pressure.
#include <string>
#include <string_view>

#include "materials/cam_clay.hpp"

namespace talus {

/// Modified Cam clay (Roscoe & Burland 1968) in Kirchhoff stress and logarithmic strain, associated, with the return by backward Euler in
/// the form of Borja & Tamagnini 1998 (CMAME 155, 73).  Pressure p = -tr/3 and shear stress q = sqrt(3 J2), compression positive:
///     elastic     p = reference_pressure (exp(-e / swelling_index) - 1), e the elastic logarithmic volume strain; shear modulus constant
///     yield       q^2 / M^2 + p (p - pc) = 0
///     hardening   pc = preconsolidation_pressure exp(-plastic_volume / (compression_index - swelling_index)).
/// The -1 differs from the usual form: with it zero strain is stress-free, and swelling lines are logarithmic in p + reference_pressure.
/// The elasticity has a potential: closed cycles inside the ellipse do not dissipate.
///
/// Cam clay bears no tension.  Where the trial pressure falls to zero the material opens: it is stress-free, the opened volume is stored
/// and must close before the material is compressed again, and the preconsolidation stays.  At positive pressure, however small, it dilates
/// and softens along the dry side of the ellipse instead; the two cases join with an error in q of M sqrt(K de pc), with the strain de of a
/// step and K = reference_pressure / swelling_index.
struct ModifiedCamClay : CamClay {
  static constexpr std::string_view name = "modified_cam_clay";
  static constexpr std::string_view summary =
      "Modified Cam clay on logarithmic elasticity with pressure-dependent bulk modulus (Roscoe & Burland 1968; Borja & Tamagnini 1998).";
  Real shear_modulus{}, compression_index{}, swelling_index{}, critical_state_slope{}, preconsolidation_pressure{}, reference_pressure{};
  static constexpr auto fields()
  {
    using Law = ModifiedCamClay;
    return std::tuple{
        required<Law, Real>("density", &Law::density, positive, "kg/m^3", "mass density at rest"),
        required("shear_modulus", &Law::shear_modulus, positive, "Pa", "elastic shear modulus, constant"),
        required("compression_index", &Law::compression_index, positive, "-",
                 "lambda, slope of ln(volume) against ln(pressure) in first compression: lambda of the void ratio over 1 + e"),
        required("swelling_index", &Law::swelling_index, positive, "-", "kappa, the same slope in unloading; below compression_index"),
        required("critical_state_slope", &Law::critical_state_slope, between(0, 3), "-",
                 "M = q / p where shear goes on without change; 6 sin(phi) / (3 - sin(phi)) for triaxial compression"),
        required("preconsolidation_pressure", &Law::preconsolidation_pressure, positive, "Pa",
                 "pressure of first yield in isotropic compression; a prestress outside the ellipse raises it"),
        required("reference_pressure", &Law::reference_pressure, positive, "Pa",
                 "swelling_index times the bulk modulus at zero pressure, K = (p + reference_pressure) / swelling_index")};
  }
  /// Appends the violated rules between parameters.
  void check(std::vector<std::string>& problems) const;
  /// Divides tan(phi) by a factor, where phi is the friction angle in triaxial compression that corresponds to M, sin(phi) = 3 M / (6 + M);
  /// the preconsolidation stays.
  void divide_strength(Real factor) noexcept { critical_state_slope = slope_over(critical_state_slope, factor); }

  Constants constants() const noexcept;
  void prestress(const Mat3& stress, State& state) const noexcept { start_under(stress, state, constants()); }
  Real yield(const Mat3&, const State& state) const noexcept { return yield_of(state, constants()); }
};

}  // namespace talus
