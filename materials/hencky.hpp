#pragma once
// Elasticity in logarithmic strain: the elastic part of Drucker-Prager.
#include <string_view>

#include "materials/parts/elasticity.hpp"
#include "materials/parts/law.hpp"
#include "materials/parts/logarithm.hpp"

namespace talus {

/// Hencky solid: J stress = lambda tr(e) I + 2 mu e with e = ln(F F^T) / 2.
struct Hencky : Elasticity {
  static constexpr std::string_view name = "hencky";
  static constexpr std::string_view summary =
      "Hencky solid, J stress = lambda tr(e) I + 2 mu e with the logarithmic strain e = ln(F F^T) / 2.";
  Real density{};
  static constexpr auto fields()
  {
    return std::tuple_cat(std::tuple{required("density", &Hencky::density, positive, "kg/m^3", "mass density at rest")},
                          elastic_fields<Hencky>());
  }
  using State = NoHistory;
  using Constants = Moduli;
  Moduli constants() const noexcept { return moduli(); }

  template <class T>
  Mat3Of<T> update(const IncrementOf<T>& in, StateOf<T, State>& state, const Moduli& c) const noexcept
  {
    const T J = in.F.determinant();
    return all_of(J > 0) ? Mat3Of<T>(kirchhoff(in.F, c) * T(1 / J)) : no_answer_somewhere(*this, in, state, c);
  }

  /// The wave moduli: along a principal axis n, rho_0 c^2 = lambda + 2 mu - J stress_nn; for shear across it, from n towards m, mu r ln(r)
  /// / (r - 1) with r = b_n / b_m, which is at most mu (1 + ln r).
  template <class T>
  T wave_speed(const Mat3Of<T>& F, const Moduli& c) const noexcept
  {
    using std::max, std::sqrt;
    const Real lambda = c.lambda, mu = c.shear;
    const T stress = largest_eigenvalue_bound(kirchhoff(F, c));
    return sqrt(T(max(T(lambda + 2 * mu + stress), T(mu + 2 * stress)) / density));
  }

 private:
  template <class T>
  static Mat3Of<T> kirchhoff(const Mat3Of<T>& F, const Moduli& c) noexcept
  {
    const Real lambda = c.lambda, mu = c.shear;
    const Sym3Of<T> strain = scale_and_shift(0.5, log1p(push_forward(F - Mat3Of<T>::Identity(), Sym3Of<T>::Zero())), 0);
    return unpack(scale_and_shift(2 * mu, strain, lambda * trace(strain)));
  }
};

}  // namespace talus
