#pragma once
// The compressible rubber of textbooks: stress from the deformation gradient alone.
#include <string_view>

#include "materials/elasticity.hpp"
#include "materials/law.hpp"
#include "materials/logarithm.hpp"

namespace talus {

/// Compressible neo-Hookean solid: J stress = mu (F F^T - I) + lambda ln(J) I.       [Bonet & Wood 2008, ch. 6]
struct NeoHookean : Elasticity {
  static constexpr std::string_view name = "neo_hookean";
  static constexpr std::string_view summary =
      "Compressible neo-Hookean solid, J stress = mu (F F^T - I) + lambda ln(J) I (Bonet & Wood 2008, ch. 6).";
  Real density{};
  static constexpr auto fields()
  {
    return std::tuple_cat(std::tuple{required("density", &NeoHookean::density, positive, "kg/m^3", "mass density at rest")},
                          elastic_fields<NeoHookean>());
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
    return (mu * (in.F * in.F.transpose() - Mat3::Identity()) + lambda * std::log(J) * Mat3::Identity()) / J;
  }

  /// From the acoustic tensor: rho_0 c^2 = lambda + mu - lambda ln J + mu b_nn along n, mu b_nn across it.
  Real wave_speed(const Mat3& F, const Moduli& c) const noexcept
  {
    const Real lambda = c.lambda, mu = c.shear;
    const Real across = mu * largest_eigenvalue_bound(F * F.transpose());
    const Real along = across + lambda + mu - lambda * std::log(F.determinant());
    return std::sqrt(std::max(along, across) / density);
  }
};

}  // namespace talus
