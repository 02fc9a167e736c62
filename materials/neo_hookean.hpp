#pragma once
// The compressible rubber of textbooks: stress from the deformation gradient alone.
#include <string_view>

#include "materials/law.hpp"
#include "materials/logarithm.hpp"

namespace talus {

/// Compressible neo-Hookean solid: J stress = mu (F F^T - I) + lambda ln(J) I.       [Bonet & Wood 2008, ch. 6]
struct NeoHookean {
  static constexpr std::string_view name = "neo_hookean";
  static constexpr std::string_view summary =
      "Compressible neo-Hookean solid, J stress = mu (F F^T - I) + lambda ln(J) I (Bonet & Wood 2008, ch. 6).";
  Real density{}, youngs_modulus{}, poisson_ratio{};
  static constexpr auto fields()
  {
    return std::tuple{required("density", &NeoHookean::density, positive, "kg/m^3", "mass density at rest"),
                      required("youngs_modulus", &NeoHookean::youngs_modulus, positive, "Pa", "Young's modulus at small strain"),
                      required("poisson_ratio", &NeoHookean::poisson_ratio, between(-1, 0.5), "-", "Poisson's ratio at small strain")};
  }
  using State = NoHistory;

  Mat3 update(const Increment& in, State&) const noexcept
  {
    const Real J = in.F.determinant();
    if (!(J > 0))
      return no_answer();
    const auto [lambda, mu] = lame(youngs_modulus, poisson_ratio);
    return (mu * (in.F * in.F.transpose() - Mat3::Identity()) + lambda * std::log(J) * Mat3::Identity()) / J;
  }

  /// From the acoustic tensor: rho_0 c^2 = lambda + mu - lambda ln J + mu b_nn along n, mu b_nn across it.
  Real wave_speed(const Mat3& F) const noexcept
  {
    const auto [lambda, mu] = lame(youngs_modulus, poisson_ratio);
    const Real across = mu * largest_eigenvalue_bound(F * F.transpose());
    const Real along = across + lambda + mu - lambda * std::log(F.determinant());
    return std::sqrt(std::max(along, across) / density);
  }
};

}  // namespace talus
