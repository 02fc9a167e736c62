#pragma once
// Hooke's law in the corotated frame, with a volume term that resists inversion: the elasticity of many graphics codes.
#include <string_view>

#include "materials/law.hpp"
#include "materials/logarithm.hpp"

namespace talus {

/// Fixed corotated solid: J stress = 2 mu (F - R) F^T + lambda J (J - 1) I, F = R U.       [Stomakhin et al. 2012, eq. 5]
struct Corotated {
  static constexpr std::string_view name = "corotated";
  static constexpr std::string_view summary =
      "Fixed corotated solid, J stress = 2 mu (F - R) F^T + lambda J (J - 1) I with F = R U (Stomakhin et al. 2012).";
  Real density{}, youngs_modulus{}, poisson_ratio{};
  static constexpr auto fields()
  {
    return std::tuple{required("density", &Corotated::density, positive, "kg/m^3", "mass density at rest"),
                      required("youngs_modulus", &Corotated::youngs_modulus, positive, "Pa", "Young's modulus at small strain"),
                      required("poisson_ratio", &Corotated::poisson_ratio, between(-1, 0.5), "-", "Poisson's ratio at small strain")};
  }
  using State = NoHistory;

  Mat3 update(const Increment& in, State&) const noexcept
  {
    const Real J = in.F.determinant();
    if (!(J > 0))
      return no_answer();
    const auto [lambda, mu] = lame(youngs_modulus, poisson_ratio);
    const Mat3 kirchhoff = 2 * mu * (in.F - polar_rotation(in.F)) * in.F.transpose() + lambda * J * (J - 1) * Mat3::Identity();
    return sym(kirchhoff) / J;
  }

  /// rho_0 c^2 <= 2 mu b_nn + lambda J^2: the volume term is linear along rank-one directions but for lambda (J - 1)^2 / 2.
  Real wave_speed(const Mat3& F) const noexcept
  {
    const auto [lambda, mu] = lame(youngs_modulus, poisson_ratio);
    const Real J = F.determinant();
    return std::sqrt((2 * mu * largest_eigenvalue_bound(F * F.transpose()) + std::max(lambda, Real{0}) * J * J) / density);
  }
};

}  // namespace talus
