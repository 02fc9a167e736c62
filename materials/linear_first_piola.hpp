#pragma once
// A law for verification: bars with exact solutions at any amplitude.
#include <string_view>

#include "materials/parts/elasticity.hpp"
#include "materials/parts/law.hpp"
#include "materials/parts/logarithm.hpp"

namespace talus {

/// First Piola stress linear in the displacement gradient, P = lambda tr(F - I) I + 2 mu (F - I).  In uniaxial strain P = M (F - 1), so the
/// wave equation in initial coordinates is linear for any strain.  For verification only: a rotation causes stress.  The Cauchy stress is P
/// F^T / J without its skew part, which is zero for diagonal F.
struct LinearFirstPiola : Elasticity {
  static constexpr std::string_view name = "linear_first_piola";
  static constexpr std::string_view summary =
      "First Piola stress linear in F, P = lambda tr(F - I) I + 2 mu (F - I); not objective, for the verification of bars only.";
  static constexpr bool objective = false;
  Real density{};
  static constexpr auto fields()
  {
    return std::tuple_cat(std::tuple{required("density", &LinearFirstPiola::density, positive, "kg/m^3", "mass density at rest")},
                          elastic_fields<LinearFirstPiola>());
  }
  using State = NoHistory;
  using Constants = Moduli;
  Moduli constants() const noexcept { return moduli(); }

  template <class T>
  Mat3Of<T> update(const IncrementOf<T>& in, StateOf<T, State>& state, const Moduli& c) const noexcept
  {
    const T J = in.F.determinant();
    if (!all_of(J > 0))
      return no_answer_somewhere(*this, in, state, c);
    const Real lambda = c.lambda, mu = c.shear;
    const Mat3Of<T> G = in.F - Mat3Of<T>::Identity();
    const Mat3Of<T> P = T(lambda * G.trace()) * Mat3Of<T>::Identity() + 2 * mu * G;
    return sym(P * in.F.transpose()) / J;
  }

  template <class T>
  T wave_speed(const Mat3Of<T>& F, const Moduli& c) const noexcept
  {
    using std::sqrt;
    const Real lambda = c.lambda, mu = c.shear;
    return sqrt(T((lambda + 2 * mu) * largest_eigenvalue_bound(Mat3Of<T>(F * F.transpose())) / density));
  }
};

}  // namespace talus
