#pragma once
// The compressible rubber of textbooks: stress from the deformation gradient only.
#include <string_view>

#include "materials/parts/elasticity.hpp"
#include "materials/parts/law.hpp"
#include "materials/parts/logarithm.hpp"

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

  template <class T>
  Mat3Of<T> update(const IncrementOf<T>& in, StateOf<T, State>&, const Moduli& c) const noexcept
  {
    using std::log;
    const T J = in.F.determinant();
    if (!any_of(J > 0))
      return no_answer<T>();
    const T per_volume = 1 / where(J > 0, J, T(std::numeric_limits<Real>::quiet_NaN())), shear = c.shear * per_volume;
    Mat3Of<T> stress = shear * (in.F * in.F.transpose());
    stress.diagonal().array() += c.lambda * per_volume * log(J) - shear;
    return stress;
  }

  /// The wave moduli from the acoustic tensor: rho_0 c^2 = lambda + mu - lambda ln J + mu b_nn along n, mu b_nn across it.
  template <class T>
  T wave_speed(const Mat3Of<T>& F, const Moduli& c) const noexcept
  {
    using std::log, std::max, std::sqrt;
    const T across = c.shear * largest_eigenvalue_bound(Mat3Of<T>(F * F.transpose()));
    const T along = across + (c.lambda + c.shear) - c.lambda * log(T(F.determinant()));
    return sqrt(T(max(along, across) / density));
  }
};

}  // namespace talus
