#pragma once
// Ductile metal with voids that grow, nucleate and join until it tears: Gurson, Tvergaard and Needleman.
#include <optional>
#include <string>
#include <string_view>

#include "materials/parts/hencky_plastic.hpp"

namespace talus {

/// Voids that open at inclusions, with a normal distribution over the strain of the matrix.  [Chu & Needleman 1980, J. Eng. Materials Technol.
/// 102, 249]
struct VoidNucleation {
  Real porosity{}, mean_strain{}, deviation{};
  static constexpr auto fields()
  {
    return std::tuple{required("porosity", &VoidNucleation::porosity, between(0, 1), "-", "f_N, that of all voids that can open"),
                      required("mean_strain", &VoidNucleation::mean_strain, positive, "-",
                               "e_N, plastic strain of the matrix at which half of them are open"),
                      required("deviation", &VoidNucleation::deviation, positive, "-", "s_N, standard deviation of that strain")};
  }
};

/// The loss of strength where voids join.  [Tvergaard & Needleman 1984, Acta Metall. 32, 157]
struct VoidCoalescence {
  Real porosity{}, failure_porosity{};
  static constexpr auto fields()
  {
    return std::tuple{
        required("porosity", &VoidCoalescence::porosity, between(0, 1), "-", "f_c, from which on voids join"),
        required("failure_porosity", &VoidCoalescence::failure_porosity, between(0, 1), "-", "f_F, at which nothing is left")};
  }
};

/// The porous metal of Gurson, Tvergaard & Needleman on logarithmic elasticity, associated, with the return by backward Euler (Aravas 1987,
/// IJNME 24, 1395).  With q = sqrt(3 J2) and the mean stress p of the Cauchy stress, tension positive, and the strength s of the matrix
///     (q / s)^2 + 2 q1 f* cosh(3 q2 p / (2 s)) - 1 - q3 f*^2 = 0,    s = yield_stress + B e^n,
///     (1 - f) s de = stress : (plastic strain),    df = (1 - f) tr(plastic strain) + A(e) de,
/// where e is the plastic strain of the matrix.  f* is f up to f_c and then grows faster, to its ultimate value at f_F, where the particle
/// has failed: it bears neither shear nor tension.
///
/// Voids close under pressure, at the porosity before the step: what closes in a step weakens that step still.  None nucleate then.
struct PorousDuctile : HenckyPlastic {
  static constexpr std::string_view name = "porous_ductile";
  static constexpr std::string_view summary =
      "Ductile metal with voids that grow, nucleate and join until it fails, on logarithmic elasticity (Gurson 1977; Chu & Needleman 1980; "
      "Tvergaard & Needleman 1984).";
  Real yield_stress{}, hardening_coefficient = 0, hardening_exponent = 1, q1 = 1.5, q2 = 1, initial_porosity{};
  std::optional<Real> q3;
  std::optional<VoidNucleation> nucleation;
  std::optional<VoidCoalescence> coalescence;
  static constexpr auto fields()
  {
    using Law = PorousDuctile;
    return std::tuple_cat(
        std::tuple{required<Law, Real>("density", &Law::density, positive, "kg/m^3", "mass density at rest")}, elastic_fields<Law>(),
        std::tuple{
            required("yield_stress", &Law::yield_stress, positive, "Pa", "strength of the matrix at first yield"),
            optional("hardening_coefficient", &Law::hardening_coefficient, non_negative, "Pa", "B, gain at plastic strain 1 of the matrix"),
            optional("hardening_exponent", &Law::hardening_exponent, positive, "-", "n of the gain B e^n"),
            required("initial_porosity", &Law::initial_porosity, from_to_below(0, 1), "-",
                     "f_0, share of the volume that is voids at the start"),
            optional("q1", &Law::q1, at_least(1), "-", "of Tvergaard 1981; 1 is Gurson's surface"),
            optional("q2", &Law::q2, positive, "-", "of Tvergaard 1981"),
            optional("q3", &Law::q3, positive, "-", "of Tvergaard 1981; without it the square of q1"),
            group("nucleation", &Law::nucleation, "voids that open with the plastic strain of the matrix; without it none"),
            group("coalescence", &Law::coalescence, "faster loss of strength where voids join; without it f* is f up to failure")});
  }
  /// Appends the violated rules between parameters.
  void check(std::vector<std::string>& problems) const;
  /// Divides the strength of the matrix by a factor at every plastic strain; porosities stay.
  void divide_strength(Real factor) noexcept
  {
    yield_stress /= factor;
    hardening_coefficient /= factor;
  }

  struct State {
    Sym3 elastic_left = Sym3::Zero();
    Real plastic_strain = 0, plastic_work = 0, matrix_strain = 0, porosity_gain = 0;
    static constexpr auto fields()
    {
      return std::tuple{
          history("elastic_left", &State::elastic_left, "-", "elastic left Cauchy-Green tensor minus identity: xx, yy, zz, xy, yz, xz"),
          history("plastic_strain", &State::plastic_strain, "-", "accumulated deviatoric plastic strain, integral of sqrt(2/3 e:e)"),
          history("plastic_work", &State::plastic_work, "J/m^3", "dissipated energy per initial volume"),
          history("matrix_strain", &State::matrix_strain, "-", "accumulated plastic strain of the matrix, which hardens it"),
          history("porosity_gain", &State::porosity_gain, "-", "porosity minus initial_porosity; failed at failure_porosity")};
    }
  };

  struct Constants {
    Real bulk, shear;           ///< Pa
    Real q3;                    ///< [-]
    Real ultimate;              ///< f* at which nothing is left
    Real begin, failure;        ///< f_c and f_F
    Real rising;                ///< slope of f* beyond f_c
    Real nucleated;             ///< f_N / (s_N sqrt(2 pi)); 0 without nucleation
    Real mean_strain, inverse;  ///< of nucleation: e_N and 1 / s_N
  };
  Constants constants() const noexcept;

  /// The strength of the matrix [Pa of Cauchy stress] at its plastic strain [-].
  Real flow_stress(Real matrix_strain) const noexcept;
  template <class T>
  Mat3Of<T> update(const IncrementOf<T>& in, StateOf<T, State>& state, const Constants& c) const noexcept;
  /// The yield function above times s [Pa]; after failure sqrt(3 J2) and tension.
  Real yield(const Mat3& stress, const State& state) const noexcept;
};

}  // namespace talus
