#pragma once
// Hooke's law in the corotated frame, with a volume term that resists inversion: the elasticity of many graphics codes.
#include <string_view>

#include "materials/elasticity.hpp"
#include "materials/law.hpp"
#include "materials/logarithm.hpp"

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

  Mat3 update(const Increment& in, State&, const Moduli& c) const noexcept
  {
    const Real J = in.F.determinant();
    if (!(J > 0))
      return no_answer();
    const Real lambda = c.lambda, mu = c.shear;
    const Mat3 kirchhoff = 2 * mu * (in.F - polar_rotation(in.F)) * in.F.transpose() + lambda * J * (J - 1) * Mat3::Identity();
    return sym(kirchhoff) / J;
  }

  /// rho_0 c^2 <= 2 mu b_nn + lambda J^2: the volume term is linear along rank-one directions but for lambda (J - 1)^2 / 2.
  Real wave_speed(const Mat3& F, const Moduli& c) const noexcept
  {
    const Real lambda = c.lambda, mu = c.shear;
    const Real J = F.determinant();
    return std::sqrt((2 * mu * largest_eigenvalue_bound(F * F.transpose()) + std::max(lambda, Real{0}) * J * J) / density);
  }
};

}  // namespace talus
