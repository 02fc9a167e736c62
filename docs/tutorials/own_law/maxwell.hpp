#pragma once
// Viscoelastic solid: the shear stress relaxes, the pressure does not.
#include <string_view>

#include "materials/parts/elasticity.hpp"
#include "materials/parts/law.hpp"
#include "materials/parts/logarithm.hpp"

namespace talus {

/// ds/dt + s / T = 2 G dev(D) for the Kirchhoff deviator s, on logarithmic elasticity; backward Euler.       [Maxwell 1867]
struct Maxwell : Elasticity {
  static constexpr std::string_view name = "maxwell";
  static constexpr std::string_view summary = "Viscoelastic solid whose shear stress relaxes (Maxwell 1867).";
  Real density{}, relaxation_time{};
  static constexpr auto fields()
  {
    return std::tuple_cat(
        std::tuple{required("density", &Maxwell::density, positive, "kg/m^3", "mass density at rest")}, elastic_fields<Maxwell>(),
        std::tuple{required("relaxation_time", &Maxwell::relaxation_time, positive, "s", "time in which the shear stress falls to 1/e")});
  }

  struct State {
    Sym3 elastic_left = Sym3::Zero();
    Real plastic_work = 0;
    static constexpr auto fields()
    {
      return std::tuple{
          history("elastic_left", &State::elastic_left, "-", "elastic left Cauchy-Green tensor minus identity: xx, yy, zz, xy, yz, xz"),
          history("plastic_work", &State::plastic_work, "J/m^3", "dissipated energy per initial volume")};
    }
  };

  struct Constants {
    Real bulk, shear;  ///< Pa
  };
  Constants constants() const noexcept
  {
    const Moduli elastic = moduli();
    return {.bulk = elastic.bulk, .shear = elastic.shear};
  }

  template <class T>
  Mat3Of<T> update(const IncrementOf<T>& in, StateOf<T, State>& state, const Constants& c) const noexcept
  {
    using std::isfinite;
    const T J = in.F.determinant();
    const Sym3Of<T> trial = push_forward(in.dt * in.L, get(state, &State::elastic_left));
    const Sym3Of<T> twice_strain = log1p(trial);
    const T volume = 0.5 * trace(twice_strain);
    if (!all_of(J > 0 && isfinite(volume)))
      return no_answer_somewhere(*this, in, state, c);
    const Sym3Of<T> shear = scale_and_shift(0.5, twice_strain, -volume / 3);
    const Real remaining = in.elastic ? 1 : 1 / (1 + in.dt / relaxation_time);
    put(state, &State::elastic_left, remaining < 1 ? expm1(scale_and_shift(2 * remaining, shear, volume * (2.0 / 3))) : trial);
    const T work = 2 * c.shear * remaining * (1 - remaining) * squared_norm(shear);  // final stress times relaxed strain
    put(state, &State::plastic_work, T(get(state, &State::plastic_work) + work));
    return unpack(scale_and_shift(2 * c.shear * remaining / J, shear, c.bulk * volume / J));
  }

  /// Sets the history so that the stress at F = I is `stress` [Pa].
  void prestress(const Mat3& stress, State& state) const noexcept
  {
    const Moduli elastic = moduli();
    state.elastic_left = expm1(add_diagonal(pack(dev(stress) / elastic.shear), 2 * stress.trace() / (9 * elastic.bulk)));
  }

  /// From rho_0 c^2 = lambda + 2 mu - (Kirchhoff stress)_nn, with the compression of uniaxial strain of the same volume.
  template <class T>
  T wave_speed(const Mat3Of<T>& F, const Constants& c) const noexcept
  {
    using std::log, std::max, std::sqrt;
    return sqrt(T((c.bulk + 4 * c.shear / 3) * (1 + max(T(-log(T(F.determinant()))), T(0))) / density));
  }
};

}  // namespace talus
