#pragma once
// Mud, debris flows and fresh concrete: a fluid with a yield stress and a viscosity that depends on the shear rate.
#include <fmt/format.h>

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "materials/parts/weakly_compressible.hpp"

namespace talus {

/// stress = -p(J) I + 2 eta dev(D),    eta = k g^(n-1) + tau_y (1 - exp(-m g)) / g,    g = sqrt(2 dev(D):dev(D)).
/// [Herschel & Bulkley 1926, Kolloid-Z. 39, 291; Papanastasiou 1987, J. Rheol. 31, 385].  Below yield the fluid creeps with the viscosity
/// tau_y m.  The viscosity of the power law is constant below g = 1/m if n < 1, and above g = highest_rate if n > 1, so that the viscosity
/// and with it the step is bounded.  n = 1 is Bingham's fluid.  For what has to stop there is ElasticHerschelBulkley.
struct HerschelBulkley : WeaklyCompressible {
  static constexpr std::string_view name = "herschel_bulkley";
  static constexpr std::string_view summary =
      "Weakly compressible fluid with yield stress, tau = tau_y + k g^n (Herschel & Bulkley 1926, regularised after Papanastasiou 1987).";
  Real yield_stress{}, consistency{}, flow_index{}, regularisation{};
  std::optional<Real> highest_rate;
  static constexpr auto fields()
  {
    using Law = HerschelBulkley;
    return std::tuple_cat(
        fluid_fields<Law>(),
        std::tuple{
            required("yield_stress", &Law::yield_stress, non_negative, "Pa", "shear stress tau_y below which it hardly flows"),
            required("consistency", &Law::consistency, non_negative, "Pa s^n", "k; the viscosity if flow_index is 1"),
            required("flow_index", &Law::flow_index, positive, "-", "n; 1 Bingham, below 1 shear-thinning, above 1 shear-thickening"),
            required("regularisation", &Law::regularisation, positive, "s",
                     "m; the yield stress is there within 5 % from the shear rate 3/m on, and below yield the viscosity is tau_y m"),
            optional("highest_rate", &Law::highest_rate, positive, "1/s",
                     "shear rate above which the power law keeps its viscosity; for a flow_index above 1, and needed there")});
  }
  /// Appends an error if a shear-thickening law has no highest rate.
  void check(std::vector<std::string>& problems) const
  {
    if (flow_index > 1 && !highest_rate)
      problems.push_back(fmt::format("flow_index {} is above 1 and needs highest_rate: without it no step is short enough", flow_index));
    if (flow_index <= 1 && highest_rate)
      problems.push_back(fmt::format("highest_rate needs a flow_index above 1, here {}", flow_index));
  }

  /// Divides the yield stress by a factor; the viscosity of the flow stays.
  void divide_strength(Real factor) noexcept { yield_stress /= factor; }

  using State = FluidHistory;
  struct Constants {
    Real slowest, fastest;  ///< shear rates between which the power law holds [1/s]
  };
  Constants constants() const noexcept
  {
    return {.slowest = flow_index < 1 ? 1 / regularisation : 0, .fastest = highest_rate.value_or(std::numeric_limits<Real>::infinity())};
  }

  /// The viscosity [Pa s] at a shear rate [1/s].
  template <class T = Real>
  T viscosity(const std::type_identity_t<T>& rate, const Constants& c) const noexcept
  {
    using std::expm1, std::max, std::min, std::pow;
    T power = 1;
    if (flow_index != 1)
      power = pow(min(max(rate, T(c.slowest)), T(c.fastest)), flow_index - 1);
    const T yielding = where(rate > 0, -expm1(T(-regularisation * rate)) / rate, regularisation);
    return consistency * power + yield_stress * yielding;
  }

  template <class T>
  Mat3Of<T> update(const IncrementOf<T>& in, StateOf<T, State>& state, const Constants& c) const noexcept
  {
    using std::sqrt;
    const T J = in.F.determinant();
    if (!all_of(J > 0))
      return no_answer_somewhere(*this, in, state, c);
    const Sym3Of<T> D = rate_of_deformation(in);
    const Sym3Of<T> shear = add_diagonal(D, -trace(D) / 3);
    const T rate = sqrt(T(2 * squared_norm(shear))), eta = viscosity<T>(rate, c);
    put(state, &State::plastic_work, T(get(state, &State::plastic_work) + J * in.dt * eta * rate * rate));
    return unpack(scale_and_shift(2 * eta, shear, -pressure<T>(J, in.elastic)));
  }
  template <class T>
  T wave_speed(const Mat3Of<T>& F, const Constants&) const noexcept
  {
    return sound_speed<T>(F.determinant());
  }
  /// 4/3 of the largest viscosity over density [m^2/s]; for a shear-thickening fluid the sum of the viscosities at rest and at
  /// highest_rate.
  Real diffusivity(const Constants& c) const noexcept
  {
    const Real power = std::pow(flow_index > 1 ? c.fastest : c.slowest, flow_index - 1);
    return 4 * (consistency * power + yield_stress * regularisation) / (3 * density);
  }
};

}  // namespace talus
