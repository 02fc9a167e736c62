#pragma once
// Foam, mud and fresh concrete that come to rest: elastic below the yield stress, above it the flow of Herschel and Bulkley.
#include <cmath>
#include <numbers>
#include <string_view>

#include "materials/parts/hencky_plastic.hpp"
#include "materials/parts/power_near.hpp"
#include "materials/parts/radial_return.hpp"
#include "materials/parts/scalar_root.hpp"

namespace talus {

/// Elastic-viscoplastic solid whose shear stress exceeds the yield stress by that of the rate of plastic shear,
///     tau = tau_y + k g^n    where tau > tau_y,  else g = 0.
/// tau = sqrt(J2) of the Cauchy stress and g = sqrt(2 Dp:Dp) are stress and rate in simple shear, as in HerschelBulkley.
/// [Herschel & Bulkley 1926, Kolloid-Z. 39, 291; with overstress as Perzyna 1966, Adv. Appl. Mech. 9, 243; Yue, Smith, Batty, Zheng &
/// Grinspun 2015, ACM Trans. Graph. 34(5), 160, with elasticity in logarithmic strain instead of their neo-Hookean one.]  The flow keeps
/// the volume, whose change is elastic.
///
/// A step is implicit in its plastic shear m, tau_trial - (G/J) m = tau_y + k (m / dt)^n, so that the viscosity does not bound the step:
/// sound does.  Steady flow has the stress tau_y + k g^n for steps of any length; the overstress of a material at rest decays to zero, and
/// a stress below tau_y stays.
struct ElasticHerschelBulkley : HenckyPlastic {
  static constexpr std::string_view name = "elastic_herschel_bulkley";
  static constexpr bool isochoric = true;
  static constexpr bool overstress = true;
  static constexpr std::string_view summary =
      "Elastic solid below its yield stress, flow with tau = tau_y + k g^n above it, on logarithmic elasticity (Herschel & Bulkley 1926; "
      "Yue et al. 2015).";
  Real yield_stress{}, consistency{}, flow_index{};
  static constexpr auto fields()
  {
    using Law = ElasticHerschelBulkley;
    return std::tuple_cat(
        std::tuple{required<Law, Real>("density", &Law::density, positive, "kg/m^3", "mass density at rest")}, elastic_fields<Law>(),
        std::tuple{
            required("yield_stress", &Law::yield_stress, non_negative, "Pa", "shear stress tau_y below which it is elastic and rests"),
            required("consistency", &Law::consistency, non_negative, "Pa s^n",
                     "k; the viscosity if flow_index is 1, and with 0 no stress exceeds tau_y"),
            required("flow_index", &Law::flow_index, positive, "-", "n; 1 Bingham, below 1 shear-thinning, above 1 shear-thickening")});
  }
  /// Divides the yield stress by a factor; the viscosity of the flow stays.
  void divide_strength(Real factor) noexcept { yield_stress /= factor; }

  struct State {
    Sym3 elastic_left = Sym3::Zero();
    Real plastic_strain = 0, plastic_work = 0;
    static constexpr auto fields()
    {
      return std::tuple{
          history("elastic_left", &State::elastic_left, "-", "elastic left Cauchy-Green tensor minus identity: xx, yy, zz, xy, yz, xz"),
          history("plastic_strain", &State::plastic_strain, "-", "accumulated plastic strain, integral of sqrt(2/3 e:e)"),
          history("plastic_work", &State::plastic_work, "J/m^3", "dissipated energy per initial volume")};
    }
  };

  struct Constants {
    Real bulk, shear;      ///< Pa
    BinomialSeries power;  ///< of the unknown in the equation of a step: n, or 1/n where n < 1
  };
  Constants constants() const noexcept
  {
    const Moduli elastic = moduli();
    return {.bulk = elastic.bulk, .shear = elastic.shear, .power = flow_index < 1 ? 1 / flow_index : flow_index};
  }

  template <class T>
  Mat3Of<T> update(const IncrementOf<T>& in, StateOf<T, State>& state, const Constants& c) const noexcept
  {
    using std::max, std::min;
    const T J = in.F.determinant();
    const ElasticTrial<T> trial(in, get(state, &State::elastic_left));
    if (!all_of(J > 0 && trial.is_finite()))
      return no_answer_somewhere(*this, in, state, c);
    const auto stress_with = [&](const T& remaining) {
      return unpack(scale_and_shift(2 * c.shear * remaining / J, trial.shear_strain, c.bulk * trial.volume_strain / J));
    };
    const T stiffness = c.shear / J, tau = std::numbers::sqrt3 * stiffness * trial.shear, over = tau - yield_stress;
    const auto yields = over > 0;
    if (in.elastic || !(in.dt > 0) || !any_of(yields)) {
      put(state, &State::elastic_left, trial.left);
      return stress_with(T(1));
    }
    const T relaxed = where(yields, over * relaxed_share(where(yields, over, 1), stiffness, in.dt, yields, c), 0);
    const T m = relaxed / stiffness, end = tau - relaxed, remaining = where(yields, end / above_nothing(tau), 1);
    put(state, &State::elastic_left, where(yields, trial.left_with(remaining), trial.left));
    put(state, &State::plastic_strain, T(get(state, &State::plastic_strain) + m * std::numbers::inv_sqrt3));
    // Plastic work by the trapezoidal rule in the Kirchhoff stress, from where the flow begins to the end of the step: exact in steady
    // flow, and at rest the elastic energy that relaxes.
    const T start = max(T(von_mises(in.stress) * std::numbers::inv_sqrt3), T(yield_stress));
    const T work = 0.5 * m * J * (min(start, tau) / growth_of(in) + end);
    put(state, &State::plastic_work, T(get(state, &State::plastic_work) + work));
    return stress_with(remaining);
  }
  /// sqrt(J2) minus the yield stress [Pa]; in flow it is positive by k g^n.
  Real yield(const Mat3& stress, const State&) const noexcept { return std::sqrt(second_invariant(stress)) - yield_stress; }

 private:
  /// The share of the trial overstress [Pa] that flow takes away within the step, in (0, 1]; in the lanes of `yields`.  What remains is
  /// k (m / dt)^n with m = share * over / stiffness.  The unknown is the share with the lower power, for n < 1 the one that remains, else
  /// the one that is taken away: either solves x + b x^p = 1 with p >= 1.  This is concave, so that Newton's method falls to the root
  /// monotonically from any point above it.
  template <class T>
  T relaxed_share(const T& over, const T& stiffness, Real dt, const MaskOf<T>& yields, const Constants& c) const noexcept
  {
    using std::min, std::pow, std::sqrt;
    if (consistency == 0)
      return T(1);
    if (flow_index == 1)
      return stiffness * dt / (consistency + stiffness * dt);
    const Real p = c.power.exponent();
    const bool thinning = flow_index < 1;
    // For n < 1 the plastic shear at the rate that bears all the overstress, over the shear that relaxes it all; else the stress of the
    // rate that relaxes it all, over the overstress.
    const T full = stiffness * dt;
    const T ratio = thinning ? T(full / over * pow(T(over / consistency), p)) : T(consistency / over * pow(T(over / full), p));
    const T b = min(ratio, T(1e300));
    if (p == 2) {
      const T x = 2 / (1 + sqrt(T(1 + 4 * b)));
      return thinning ? T(b * x * x) : x;
    }
    const T guess = min(T(1), pow(b, -1 / p));
    PowerNear<T> power(guess, c.power);
    const auto remainder = [&](const T& at) -> ValueAndSlopeOf<T> {
      const T term = b * power.advance(at);
      return {1 - at - term, -1 - p * term / above_nothing(at)};
    };
    const T x = positive_root<T>(remainder, T(1), guess, yields);
    return thinning ? T(b * power(x)) : x;  // not 1 - x, which would be rounding where hardly anything flows
  }
};

}  // namespace talus
