#pragma once
// Small-strain elasticity in an objective rate form.
#include <string_view>

#include "materials/elasticity.hpp"
#include "materials/law.hpp"
#include "materials/logarithm.hpp"

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

  Mat3 update(const Increment& in, State&, const Moduli& c) const noexcept
  {
    if (!(in.F.determinant() > 0))
      return no_answer();
    const Real lambda = c.lambda, mu = c.shear;
    const Mat3 H = in.dt * in.L;
    const Sym3 strain = scale_and_shift(0.5, log1p(push_forward(H.transpose(), Sym3::Zero())), 0);  // C - I = f^T f - I
    const Mat3 R = (Mat3::Identity() + H) * unpack(add_diagonal(expm1(scale_and_shift(-1, strain, 0)), 1));
    const Mat3 unrotated = in.stress + unpack(scale_and_shift(2 * mu, strain, lambda * trace(strain)));
    return sym(R * unrotated * R.transpose());
  }

  /// The stress is its own history: it may start from any value.
  void prestress(const Mat3&, State&) const noexcept {}

  Real wave_speed(const Mat3& F, const Moduli& c) const noexcept
  {
    const Real lambda = c.lambda, mu = c.shear;
    return std::sqrt((lambda + 2 * mu) * F.determinant() / density);
  }
};

}  // namespace talus
