#pragma once
// Hooke's law in the corotated frame with a volume term that resists inversion: the elasticity of many graphics codes.
#include <string_view>

#include "materials/parts/elasticity.hpp"
#include "materials/parts/law.hpp"
#include "materials/parts/logarithm.hpp"

namespace talus {

/// Fixed corotated solid: J stress = 2 mu (F - R) F^T + lambda J (J - 1) I, F = R U.       [Stomakhin et al. 2012, eq. 5]
struct Corotated : Elasticity {
  static constexpr std::string_view name = "corotated";
  static constexpr std::string_view summary =
      "Fixed corotated solid, J stress = 2 mu (F - R) F^T + lambda J (J - 1) I with F = R U (Stomakhin et al. 2012).";
  Real density{};
  static constexpr auto fields()
  {
    return std::tuple_cat(std::tuple{required("density", &Corotated::density, positive, "kg/m^3", "mass density at rest")},
                          elastic_fields<Corotated>());
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
    const Mat3Of<T> kirchhoff = 2 * mu * (in.F - polar_rotation(in.F)) * in.F.transpose() + T(lambda * J * (J - 1)) * Mat3Of<T>::Identity();
    return sym(kirchhoff) * T(1 / J);
  }

  /// An upper bound: rho_0 c^2 <= 2 mu b_nn + lambda J^2.  The volume term is linear along rank-one directions except for lambda (J - 1)^2
  /// / 2.
  template <class T>
  T wave_speed(const Mat3Of<T>& F, const Moduli& c) const noexcept
  {
    using std::sqrt;
    const T J = F.determinant();
    const T stretch = largest_eigenvalue_bound(Mat3Of<T>(F * F.transpose()));
    return sqrt(T((2 * c.shear * stretch + std::max(c.lambda, Real{0}) * J * J) / density));
  }
};

}  // namespace talus
