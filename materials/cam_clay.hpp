#pragma once
// What the laws of the Cam clay family have in common: history, elasticity and hardening as curves, an ellipse, and the return to it.
#include "materials/law.hpp"

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

/// In Kirchhoff stress and logarithmic strain, p and compaction positive in compression, pc the preconsolidation pressure:
///     elasticity  exponential  p = reference (exp(compression / swelling) - 1),    or linear  p = bulk compression
///     ellipse     q^2 / slope^2 + (p + cohesion pc) (p - pc) = 0
///     hardening   exponential  pc = preconsolidation exp(compaction / plastic),    or  pc = bulk sinh(rate max(compacted + compaction, 0)).
struct CamClayConstants {
  Real shear, reference, preconsolidation;  ///< stresses [Pa]
  Real slope;                               ///< of the ellipse [-]: M / sqrt(1 + 2 cohesion)
  Real swelling, plastic;                   ///< kappa and lambda - kappa [-]
  Real bulk;                                ///< at zero pressure [Pa]
  Real cohesion = 0;                        ///< beta, strength in isotropic tension over pc [-]
  Real rate = 0;                            ///< xi of the hyperbolic sine [-]; 0: exponential hardening
  Real compacted = 0;                       ///< what the argument of the hyperbolic sine is at the start, over its rate [-]
  bool linear = false;                      ///< linear elasticity

  template <class T>
  T pressure(const T& compression) const noexcept
  {
    using std::expm1;
    return linear ? T(bulk * compression) : T(reference * expm1(T(compression / swelling)));
  }
  /// The compression under a pressure.
  template <class T>
  T compression_under(const T& p) const noexcept
  {
    using std::log1p;
    return linear ? T(p / bulk) : T(swelling * log1p(T(p / reference)));
  }
  /// The bulk modulus under a pressure.
  template <class T>
  T stiffness(const T& p) const noexcept
  {
    return linear ? T(bulk) : T((p + reference) / swelling);
  }
  /// The energy of an elastic compression [J/m^3].
  template <class T>
  T energy(const T& compression) const noexcept
  {
    return linear ? T(0.5 * bulk * compression * compression) : T(swelling * pressure(compression) - reference * compression);
  }
  template <class T>
  T preconsolidation_at(const T& plastic_volume) const noexcept
  {
    using std::exp;
    return rate > 0 ? sinh_of(compaction_left(plastic_volume)) : T(preconsolidation * exp(T(-plastic_volume / plastic)));
  }
  /// The compaction whose loss leaves no strength [-], for hardening by the hyperbolic sine.
  template <class T>
  T compaction_left(const T& plastic_volume) const noexcept
  {
    using std::max;
    return max(T(compacted - plastic_volume), T(0));
  }
  /// pc [Pa] of a total compaction >= 0 [-], for hardening by the hyperbolic sine.
  template <class T>
  T sinh_of(const T& compaction) const noexcept
  {
    using std::expm1, std::min;
    const T more = expm1(T(rate * compaction)), finite = min(more, T(1e17));
    return 0.5 * bulk * (more + finite / (1 + finite));
  }
};

/// The law but for its parameters: each law of the family has its own keys, from which the constants follow.
struct CamClay {
  Real density{};  ///< kg/m^3 at rest
  using State = CamClayState;
  using Constants = CamClayConstants;

  template <class T>
  Mat3Of<T> update(const IncrementOf<T>& in, StateOf<T, State>& state, const Constants& c) const noexcept;
  /// A bound for material that reached F from rest by elastic strain.  Without the history, plastic compaction makes the bound large, and
  /// after a prestress or dilation the material may be stiffer than the bound.
  Real wave_speed(const Mat3& F, const Constants& c) const noexcept;
  /// The wave speed from the elastic strain in the history: rho_0 c^2 = K + 4/3 G - (Kirchhoff stress)_nn.
  template <class T>
  T wave_speed(const Mat3Of<T>& F, const StateOf<T, State>& state, const Constants& c) const noexcept;

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
