#pragma once
// Linear viscoelasticity: shear stress that relaxes to a share of what it was, by a Prony series.
#include <fmt/format.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "materials/parts/hencky_plastic.hpp"
#include "materials/parts/radial_return.hpp"

namespace talus {

/// A further share of the shear modulus that relaxes, with a time of its own.
struct PronyTerm {
  Real share{}, time{};
  static constexpr auto fields()
  {
    return std::tuple{required("share", &PronyTerm::share, positive, "-", "share of the shear modulus at once that relaxes"),
                      required("time", &PronyTerm::time, positive, "s", "time in which its stress falls to 1/e")};
  }
};

/// Springs and dashpots side by side (Wiechert 1893): a spring, and up to three of a spring and a dashpot in series, in shear; pressure
/// does not relax.  The relaxation modulus is a Prony series,
///     G(t) = G (1 - sum_i g_i (1 - exp(-t / T_i))).
/// Each part has an elastic logarithmic strain of its own, whose deviator decays; see Reese and Govindjee 1998, Int. J. Solids Struct. 35,
/// 3455, for finite strain.  A step is the decay over half of it, the deformation, and the decay over the other half: of second order, and
/// exact at rest.
struct Viscoelastic : HenckyPlastic {
  static constexpr std::string_view name = "viscoelastic";
  static constexpr std::string_view summary =
      "Linear viscoelasticity in shear by a Prony series of up to three terms, on logarithmic elasticity (Wiechert 1893; Reese and "
      "Govindjee "
      "1998).";
  Real relaxing_share{}, relaxation_time{};
  std::optional<PronyTerm> second, third;
  static constexpr auto fields()
  {
    using Law = Viscoelastic;
    return std::tuple_cat(
        std::tuple{required<Law, Real>("density", &Law::density, positive, "kg/m^3", "mass density at rest")}, elastic_fields<Law>(),
        std::tuple{required("relaxing_share", &Law::relaxing_share, positive, "-",
                            "share of the shear modulus that relaxes; the elastic constants are those of fast loading"),
                   required("relaxation_time", &Law::relaxation_time, positive, "s", "time in which the stress of this share falls to 1/e"),
                   group("second", &Law::second, "a second share, with another time"), group("third", &Law::third, "a third share")});
  }
  void check(std::vector<std::string>& problems) const
  {
    Elasticity::check(problems);
    if (const Real left = constants().share_left; !(left > 0))
      problems.push_back(
          fmt::format("the shares of what relaxes add up to {:.6g}: they have to leave a part of the shear modulus", 1 - left));
  }

  struct State {
    Sym3 elastic_left = Sym3::Zero();
    Sym3 first_strain = Sym3::Zero(), second_strain = Sym3::Zero(), third_strain = Sym3::Zero();
    Real plastic_work = 0;
    static constexpr auto fields()
    {
      return std::tuple{
          history("elastic_left", &State::elastic_left, "-", "elastic left Cauchy-Green tensor minus identity: xx, yy, zz, xy, yz, xz"),
          history("first_strain", &State::first_strain, "-", "deviator of the elastic logarithmic strain of the first part that relaxes"),
          history("second_strain", &State::second_strain, "-", "the same of the second part"),
          history("third_strain", &State::third_strain, "-", "the same of the third part"),
          history("plastic_work", &State::plastic_work, "J/m^3", "dissipated energy per initial volume")};
    }
  };

  struct Constants {
    Real bulk, shear;                    ///< in fast loading [Pa]
    Real share_left;                     ///< of the shear modulus, after all has relaxed
    std::array<Real, 3> share, inverse;  ///< of each part, and 1 / T [1/s]
  };
  Constants constants() const noexcept
  {
    const Moduli elastic = moduli();
    Constants c{.bulk = elastic.bulk, .shear = elastic.shear, .share_left = 1, .share = {}, .inverse = {}};
    const PronyTerm first{relaxing_share, relaxation_time}, absent{0, 1};
    std::size_t k = 0;
    for (const PronyTerm& term : {first, second.value_or(absent), third.value_or(absent)}) {
      c.share_left -= term.share;
      c.share[k] = term.share, c.inverse[k] = 1 / term.time;
      ++k;
    }
    return c;
  }

  template <class T>
  Mat3Of<T> update(const IncrementOf<T>& in, StateOf<T, State>& state, const Constants& c) const noexcept
  {
    const T J = in.F.determinant();
    const ElasticTrial<T> elastic(in, get(state, &State::elastic_left));
    if (!all_of(J > 0 && elastic.is_finite()))
      return no_answer_somewhere(*this, in, state, c);
    put(state, &State::elastic_left, elastic.left);
    Sym3Of<T> shear_stress = scale_and_shift(2 * c.shear * c.share_left, elastic.shear_strain, 0);  // of Kirchhoff
    T work = 0;
    constexpr std::array parts{&State::first_strain, &State::second_strain, &State::third_strain};
    for (std::size_t k = 0; k < parts.size(); ++k) {
      if (c.share[k] == 0)
        continue;
      const Sym3Of<T> before = get(state, parts[k]);
      const Real half = in.elastic ? 1 : std::exp(-0.5 * in.dt * c.inverse[k]);
      const ElasticTrial<T> trial(in, expm1(scale_and_shift(2 * half, before, 0)));
      const Sym3Of<T> strain = scale_and_shift(half, trial.shear_strain, 0);
      shear_stress += scale_and_shift(2 * c.shear * c.share[k], strain, 0);
      put(state, parts[k], strain);
      // The elastic energy that is lost in the two halves.
      work += c.shear * c.share[k] * (1 - half * half) * (squared_norm(before) + squared_norm(trial.shear_strain));
    }
    put(state, &State::plastic_work, T(get(state, &State::plastic_work) + work));
    return unpack(add_diagonal(scale_and_shift(1 / J, shear_stress, 0), T(c.bulk * elastic.volume_strain / J)));
  }

  /// Sets the history so that the stress at F = I is `stress` [Pa], with all that relaxes relaxed.
  void prestress(const Mat3& stress, State& state) const noexcept
  {
    const Constants c = constants();
    state.elastic_left = elastic_left_of(dev(stress), c.shear * c.share_left, stress.trace() / (3 * c.bulk));
  }
};

}  // namespace talus
