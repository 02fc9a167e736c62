#pragma once
// Small-strain elasticity in an objective rate form.
#include <string_view>

#include "materials/parts/elasticity.hpp"
#include "materials/parts/law.hpp"
#include "materials/parts/logarithm.hpp"

namespace talus {

/// Hooke's law for the Cauchy stress.  With the polar decomposition I + dt L = R U of the step and e = ln U,
///     stress = R (stress_old + lambda tr(e) I + 2 mu e) R^T,
/// exact for a step that is a rotation and for stretches along fixed axes (stress = M ln F in uniaxial strain).  Hypoelastic: a closed
/// cycle of large strain may leave stress behind.
struct LinearElastic : Elasticity {
  static constexpr std::string_view name = "linear_elastic";
  static constexpr std::string_view summary =
      "Hooke's law for the Cauchy stress, turned with the rotation of the step (rate form; small elastic strains).";
  Real density{};
  static constexpr auto fields()
  {
    return std::tuple_cat(std::tuple{required("density", &LinearElastic::density, positive, "kg/m^3", "mass density at rest")},
                          elastic_fields<LinearElastic>());
  }
  using State = NoHistory;
  using Constants = Moduli;
  Moduli constants() const noexcept { return moduli(); }

  template <class T>
  Mat3Of<T> update(const IncrementOf<T>& in, StateOf<T, State>& state, const Moduli& c) const noexcept
  {
    if (!all_of(in.F.determinant() > 0))
      return no_answer_somewhere(*this, in, state, c);
    const Real lambda = c.lambda, mu = c.shear;
    const Mat3Of<T> H = in.dt * in.L;
    const Sym3Of<T> strain = scale_and_shift(0.5, log1p(push_forward(H.transpose(), Sym3Of<T>::Zero())), 0);  // C - I = f^T f - I
    const Mat3Of<T> R = (Mat3Of<T>::Identity() + H) * unpack(add_diagonal(expm1(scale_and_shift(-1, strain, 0)), 1));
    const Mat3Of<T> unrotated = in.stress + unpack(scale_and_shift(2 * mu, strain, lambda * trace(strain)));
    return sym(R * unrotated * R.transpose());
  }

  /// Does nothing: the stress is the history of this law, so it may start from any value.
  void prestress(const Mat3&, State&) const noexcept {}

  template <class T>
  T wave_speed(const Mat3Of<T>& F, const Moduli& c) const noexcept
  {
    using std::sqrt;
    const Real lambda = c.lambda, mu = c.shear;
    return sqrt(T((lambda + 2 * mu) * F.determinant() / density));
  }
};

}  // namespace talus
