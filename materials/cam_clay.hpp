#pragma once
// What the laws of the Cam clay family have in common: history, elasticity and hardening as curves, an ellipse, and the return to it.
#include "materials/parts/law.hpp"

namespace talus {

struct CamClayState {
  Sym3 elastic_left = Sym3::Zero();
  Real plastic_volume = 0, plastic_strain = 0, plastic_work = 0, opened_volume = 0;
  static constexpr auto fields()
  {
    using State = CamClayState;
    return std::tuple{
        history("elastic_left", &State::elastic_left, "-", "elastic left Cauchy-Green tensor minus identity: xx, yy, zz, xy, yz, xz"),
        history("plastic_volume", &State::plastic_volume, "-", "logarithmic plastic volume strain, negative in compaction"),
        history("plastic_strain", &State::plastic_strain, "-", "accumulated deviatoric plastic strain, integral of sqrt(2/3 e:e)"),
        history("plastic_work", &State::plastic_work, "J/m^3", "dissipated energy per initial volume"),
        history("opened_volume", &State::opened_volume, "-", "logarithmic volume strain kept open; closes before compression is felt")};
  }
};

template <bool linear, bool sine>
struct CamClayCurves;

/// What follows from the parameters of any law of the family.
struct CamClayConstants {
  Real shear, reference, preconsolidation;  ///< stresses [Pa]
  Real slope;                               ///< of the ellipse [-]: M / sqrt(1 + 2 cohesion)
  Real swelling, plastic;                   ///< kappa and lambda - kappa [-]
  Real bulk;                                ///< at zero pressure [Pa]
  Real cohesion = 0;                        ///< beta, strength in isotropic tension over pc [-]
  Real rate = 0;                            ///< xi of the hyperbolic sine [-]; 0: exponential hardening
  Real compacted = 0;                       ///< compaction at the start [-], for hardening by the hyperbolic sine
  bool linear = false;                      ///< linear elasticity

  /// Calls f with the curves that are chosen here.
  template <class F>
  auto with_curves(F&& f) const noexcept;
  Real pressure(Real compression) const noexcept;
  Real compression_under(Real p) const noexcept;
  Real preconsolidation_at(Real plastic_volume) const noexcept;
};

/// In Kirchhoff stress and logarithmic strain, p and compaction positive in compression, pc the preconsolidation pressure:
///     elasticity  exponential  p = reference (exp(compression / swelling) - 1),    or linear  p = bulk compression
///     ellipse     q^2 / slope^2 + (p + cohesion pc) (p - pc) = 0
///     hardening   exponential  pc = preconsolidation exp(-plastic_volume / plastic),
///                 or by the hyperbolic sine  pc = bulk sinh(rate max(compacted - plastic_volume, 0)).
/// The choice is one of types, so that each is compiled as if it were the only one.
template <bool linear, bool sine>
struct CamClayCurves {
  const CamClayConstants& c;
  /// With the hyperbolic sine nothing is left of pc after a finite dilation.
  static constexpr bool ends = sine;

  template <class T>
  T pressure(const T& compression) const noexcept
  {
    using std::expm1;
    if constexpr (linear)
      return c.bulk * compression;
    else
      return c.reference * expm1(T(compression / c.swelling));
  }
  /// The compression under a pressure.
  template <class T>
  T compression_under(const T& p) const noexcept
  {
    using std::log1p;
    if constexpr (linear)
      return p / c.bulk;
    else
      return c.swelling * log1p(T(p / c.reference));
  }
  /// The bulk modulus under a pressure.
  template <class T>
  T stiffness(const T& p) const noexcept
  {
    if constexpr (linear)
      return c.bulk;
    else
      return (p + c.reference) / c.swelling;
  }
  /// The energy of an elastic compression [J/m^3].
  template <class T>
  T energy(const T& compression) const noexcept
  {
    if constexpr (linear)
      return 0.5 * c.bulk * compression * compression;
    else
      return c.swelling * pressure(compression) - c.reference * compression;
  }
  template <class T>
  T preconsolidation_at(const T& plastic_volume) const noexcept
  {
    using std::exp;
    if constexpr (sine)
      return of_compaction(compaction_left(plastic_volume));
    else
      return c.preconsolidation * exp(T(-plastic_volume / c.plastic));
  }
  /// The compaction whose loss leaves no strength [-], for hardening by the hyperbolic sine.
  template <class T>
  T compaction_left(const T& plastic_volume) const noexcept
  {
    using std::max;
    return max(T(c.compacted - plastic_volume), T(0));
  }
  /// pc [Pa] after a further compaction, from `start` or with a compaction `left` before.
  template <class T>
  T preconsolidation_after(const T& compaction, const T& start, const T& left) const noexcept
  {
    using std::exp, std::max;
    if constexpr (sine)
      return of_compaction(max(T(left + compaction), T(0)));
    else
      return start * exp(T(compaction / c.plastic));
  }
  /// Change of pc by compaction [Pa].
  template <class T>
  T hardening(const T& pc) const noexcept
  {
    using std::sqrt;
    if constexpr (sine)
      return c.rate * sqrt(T(c.bulk * c.bulk + pc * pc));
    else
      return pc / c.plastic;
  }

 private:
  template <class T>
  T of_compaction(const T& compaction) const noexcept
  {
    using std::expm1, std::min;
    const T more = expm1(T(c.rate * compaction)), finite = min(more, T(1e17));
    return 0.5 * c.bulk * (more + finite / (1 + finite));
  }
};

template <class F>
auto CamClayConstants::with_curves(F&& f) const noexcept
{
  if (rate > 0)
    return linear ? f(CamClayCurves<true, true>{*this}) : f(CamClayCurves<false, true>{*this});
  return linear ? f(CamClayCurves<true, false>{*this}) : f(CamClayCurves<false, false>{*this});
}
inline Real CamClayConstants::pressure(Real compression) const noexcept
{
  return with_curves([&](const auto& curves) { return curves.pressure(compression); });
}
inline Real CamClayConstants::compression_under(Real p) const noexcept
{
  return with_curves([&](const auto& curves) { return curves.compression_under(p); });
}
inline Real CamClayConstants::preconsolidation_at(Real plastic_volume) const noexcept
{
  return with_curves([&](const auto& curves) { return curves.preconsolidation_at(plastic_volume); });
}

/// The law but for its parameters: each law of the family has its own keys, from which the constants follow.
struct CamClay {
  Real density{};  ///< kg/m^3 at rest
  using State = CamClayState;
  using Constants = CamClayConstants;

  template <class T>
  Mat3Of<T> update(const IncrementOf<T>& in, StateOf<T, State>& state, const Constants& c) const noexcept
  {
    return c.with_curves([&](const auto& curves) { return update_along(curves, in, state); });
  }
  /// A bound for material that reached F from rest by elastic strain.  Without the history, plastic compaction makes the bound large, and
  /// after a prestress or dilation the material may be stiffer than the bound.
  Real wave_speed(const Mat3& F, const Constants& c) const noexcept;
  /// The wave speed from the elastic strain in the history: rho_0 c^2 = K + 4/3 G - (Kirchhoff stress)_nn.
  template <class T>
  T wave_speed(const Mat3Of<T>& F, const StateOf<T, State>& state, const Constants& c) const noexcept;

 private:
  template <class Curves, class T>
  Mat3Of<T> update_along(const Curves& curves, const IncrementOf<T>& in, StateOf<T, State>& state) const noexcept;

 protected:
  /// Sets the history for a stress.  A stress outside the ellipse raises the preconsolidation so that the stress lies on it; tension without
  /// cohesion opens the material in the first step.
  static void start_under(const Mat3& stress, State& state, const Constants& c) noexcept;
  /// The yield function (q^2 / slope^2 + (p + cohesion pc) (p - pc)) / pc [Pa] of the Kirchhoff stress of the elastic strain in `state`.
  static Real yield_of(const State& state, const Constants& c) noexcept;
  /// The slope M after division of tan(phi) by a factor, where sin(phi) = 3 M / (6 + M).
  static Real slope_over(Real slope, Real factor) noexcept;
};

}  // namespace talus
