#pragma once
// Clay that hardens by compaction: the ellipse of Cam clay on elasticity with an exponential pressure.
#include <string>
#include <string_view>

#include "materials/law.hpp"

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
struct ModifiedCamClay {
  static constexpr std::string_view name = "modified_cam_clay";
  static constexpr std::string_view summary =
      "Modified Cam clay on logarithmic elasticity with pressure-dependent bulk modulus (Roscoe & Burland 1968; Borja & Tamagnini 1998).";
  Real density{}, shear_modulus{}, compression_index{}, swelling_index{}, critical_state_slope{}, preconsolidation_pressure{},
      reference_pressure{};
  static constexpr auto fields()
  {
    using Law = ModifiedCamClay;
    return std::tuple{
        required("density", &Law::density, positive, "kg/m^3", "mass density at rest"),
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
  void divide_strength(Real factor) noexcept;

  struct State {
    Sym3 elastic_left = Sym3::Zero();
    Real plastic_volume = 0, plastic_strain = 0, plastic_work = 0, opened_volume = 0;
    static constexpr auto fields()
    {
      return std::tuple{
          history("elastic_left", &State::elastic_left, "-", "elastic left Cauchy-Green tensor minus identity: xx, yy, zz, xy, yz, xz"),
          history("plastic_volume", &State::plastic_volume, "-",
                  "logarithmic plastic volume strain, negative in compaction: -(lambda - kappa) ln(pc / preconsolidation_pressure)"),
          history("plastic_strain", &State::plastic_strain, "-", "accumulated deviatoric plastic strain, integral of sqrt(2/3 e:e)"),
          history("plastic_work", &State::plastic_work, "J/m^3", "dissipated energy per initial volume"),
          history("opened_volume", &State::opened_volume, "-", "logarithmic volume strain kept open; closes before compression is felt")};
    }
  };

  struct Constants {
    Real shear, reference, preconsolidation;  ///< stresses [Pa]
    Real slope;                               ///< M [-]
    Real swelling, plastic;                   ///< kappa and lambda - kappa [-]
    template <class T>
    T pressure(const T& compression) const noexcept
    {
      using std::expm1;
      return reference * expm1(T(compression / swelling));
    }
    template <class T>
    T preconsolidation_at(const T& plastic_volume) const noexcept
    {
      using std::exp;
      return preconsolidation * exp(T(-plastic_volume / plastic));
    }
  };
  Constants constants() const noexcept;

  template <class T>
  Mat3Of<T> update(const IncrementOf<T>& in, StateOf<T, State>& state, const Constants& c) const noexcept;
  /// Sets the history for a stress.  A stress outside the ellipse raises the preconsolidation so that the stress lies on it; tension opens
  /// the material in the first step.
  void prestress(const Mat3& stress, State& state) const noexcept;
  /// The yield function (q^2 / M^2 + p (p - pc)) / pc [Pa] of the Kirchhoff stress that belongs to the elastic strain of `state`; the
  /// Cauchy stress is the Kirchhoff stress over J.
  Real yield(const Mat3& stress, const State& state) const noexcept;
  /// A bound for material that reached F from rest by elastic strain.  Without the history, plastic compaction makes the bound large, and
  /// after a prestress or dilation the material may be stiffer than the bound.
  Real wave_speed(const Mat3& F, const Constants& c) const noexcept;
  /// The wave speed from the elastic strain in the history: rho_0 c^2 = K + 4/3 G - (Kirchhoff stress)_nn.
  template <class T>
  T wave_speed(const Mat3Of<T>& F, const StateOf<T, State>& state, const Constants& c) const noexcept;
};

}  // namespace talus
