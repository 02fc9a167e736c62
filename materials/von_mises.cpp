#include "materials/von_mises.hpp"

#include <fmt/format.h>

#include "materials/parts/radial_return.hpp"
#include "materials/parts/scalar_root.hpp"

namespace talus {

namespace {

/// The strength in slow loading at a plastic strain, computed fast near the value before the step; its slope is that at positive plastic
/// strain.
template <class T>
struct Hardening {
  const VonMises& law;
  const VonMises::Constants& c;
  const T* softened_at;  ///< as IncrementOf::softened_at
  PowerNear<T> gain;

  Hardening(const VonMises& of, const VonMises::Constants& constants, const T& plastic_strain, const T* at) noexcept
      : law(of), c(constants), softened_at(at), gain(of.power ? plastic_strain : T(0), constants.power)
  {}
  ValueAndSlopeOf<T> operator()(const T& plastic_strain) const noexcept
  {
    using std::exp;
    ValueAndSlopeOf<T> strength{law.yield_stress + law.hardening_modulus * plastic_strain, law.hardening_modulus};
    if (law.voce) {
      const T missing = law.voce->saturation * exp(T(-law.voce->exponent * plastic_strain));
      strength.value += law.voce->saturation - missing;
      strength.slope += law.voce->exponent * missing;
    }
    if (law.power) {
      const T gained = law.power->coefficient * gain(plastic_strain);
      strength.value += gained;
      strength.slope += where(plastic_strain > 0, law.power->exponent * gained / above_nothing(plastic_strain), infinitely_steep);
    }
    if (c.lost > 0) {
      const bool constant = softened_at != nullptr;
      strength.value -= c.lost_at<T>(constant ? *softened_at : plastic_strain);
      if (!constant)
        strength.slope -= where(c.softening * plastic_strain < c.lost, c.softening, 0);
    }
    return strength;
  }
  /// The lowest strength that softening can still lead to, of what is not less than `start` without it.
  T least(const T& start, const T& plastic_strain) const noexcept
  {
    return c.lost > 0 && softened_at == nullptr ? T(start - (c.lost - c.lost_at<T>(plastic_strain))) : start;
  }
};

/// The return by backward Euler from a trial stress above the strength before the step.
template <class T>
struct VonMisesReturn {
  const VonMises& law;
  const Hardening<T>& slow;
  ValueAndSlopeOf<T> start;  ///< strength before the step [Pa]
  T mises, stiffness;        ///< von Mises stress (Cauchy) of the trial state and its decrease per plastic strain [Pa]
  T plastic_strain;          ///< plastic strain before the step
  Real relative, power;      ///< plastic rate over D, per plastic strain of the step; 1/q

  ValueAndSlopeOf<T> rate_factor(const T& x) const noexcept
  {
    using std::pow;
    if (!law.rate)
      return {1, 0};
    const T gain = pow(T(relative * x), power);
    return {1 + gain, power * gain / above_nothing(x)};
  }
  /// Stress minus strength for the plastic strain x of the step.
  ValueAndSlopeOf<T> operator()(const T& x) const noexcept
  {
    const ValueAndSlopeOf<T> end = slow(plastic_strain + x), factor = rate_factor(x);
    return {mises - stiffness * x - end.value * factor.value, -stiffness - end.slope * factor.value - end.value * factor.slope};
  }
  T plastic_increment(const Mat3Of<T>& stress_before, const MaskOf<T>& yields) const noexcept
  {
    using std::max;
    const T going_on = max(start.value, talus::von_mises(stress_before));  // continuing flow hardens at the same rate
    return positive_root<T>(*this, (mises - slow.least(start.value, plastic_strain)) / stiffness,
                            (mises - going_on) / (stiffness + start.slope), yields);
  }
};

/// The Cauchy stress with the given fraction of the shear strain.
template <class T>
Mat3Of<T> stress_with(const ElasticTrial<T>& trial, const T& J, const T& remaining, const VonMises::Constants& c) noexcept
{
  return unpack(scale_and_shift(2 * c.shear * remaining / J, trial.shear_strain, c.bulk * trial.volume_strain / J));
}

}  // namespace

VonMises::Constants VonMises::constants() const noexcept
{
  const Moduli elastic = moduli();
  return {.bulk = elastic.bulk,
          .shear = elastic.shear,
          .closed_form = !voce && !power && !rate && (!residual_stress || softening_length),
          .rate_inverse = rate ? 1 / rate->reference_rate : 0,
          .rate_power = rate ? 1 / rate->exponent : 1,
          .power = power ? power->exponent : 1,
          .lost = residual_stress ? yield_stress - *residual_stress : 0,
          .softening = residual_stress && softening_strain ? (yield_stress - *residual_stress) / *softening_strain : 0};
}

void VonMises::check(std::vector<std::string>& problems) const
{
  Elasticity::check(problems);
  if (residual_stress && *residual_stress > yield_stress)
    problems.push_back(fmt::format("residual_stress {} is above yield_stress {}", *residual_stress, yield_stress));
  if (residual_stress.has_value() != softening_strain.has_value())
    problems.emplace_back("residual_stress and softening_strain need each other");
  if (softening_length && !softening_strain)
    problems.emplace_back("softening_length needs softening_strain");
  const Constants c = constants();
  if (!softening_length && c.softening >= 3 * c.shear)
    problems.push_back(
        fmt::format("softening by {:.4g} Pa per plastic strain is more than three times the shear modulus, {:.4g} Pa, which a "
                    "material of its own cannot follow: take a larger softening_strain or a softening_length",
                    c.softening, 3 * c.shear));
}

Real VonMises::flow_stress(Real plastic_strain, Real plastic_rate, Real softened_at) const noexcept
{
  const Real factor = rate ? 1 + std::pow(plastic_rate / rate->reference_rate, 1 / rate->exponent) : 1;
  const Constants c = constants();
  return Hardening<Real>(*this, c, plastic_strain, &softened_at)(plastic_strain).value * factor;
}

void VonMises::divide_strength(Real factor) noexcept
{
  yield_stress /= factor;
  if (residual_stress)
    *residual_stress /= factor;
  hardening_modulus /= factor;
  if (voce)
    voce->saturation /= factor;
  if (power)
    power->coefficient /= factor;
}

template <class T>
Mat3Of<T> VonMises::update(const IncrementOf<T>& in, StateOf<T, State>& state, const Constants& c) const noexcept
{
  const T J = in.F.determinant();
  const ElasticTrial<T> trial(in, get(state, &State::elastic_left));
  if (!all_of(J > 0 && trial.is_finite()))
    return no_answer_somewhere(*this, in, state, c);
  const T stiffness = 3 * c.shear / J, mises = stiffness * trial.shear;  // change of the Cauchy stress per strain, at constant J
  const T plastic_strain = get(state, &State::plastic_strain);
  const Hardening<T> slow(*this, c, plastic_strain, in.softened_at);
  const ValueAndSlopeOf<T> start = slow(plastic_strain);
  const auto yields = mises > start.value;
  if (in.elastic || !any_of(yields)) {
    put(state, &State::elastic_left, trial.left);
    return stress_with(trial, J, T(1), c);
  }
  const VonMisesReturn<T> map{*this, slow, start, mises, stiffness, plastic_strain, c.rate_inverse / in.dt, c.rate_power};
  const T root = c.closed_form ? T((mises - start.value) / (stiffness + hardening_modulus)) : map.plastic_increment(in.stress, yields);
  const T x = where(yields, root, 0), end = mises - stiffness * x, remaining = where(yields, end / above_nothing(mises), 1);
  put(state, &State::elastic_left, where(yields, trial.left_with(remaining), trial.left));
  put(state, &State::plastic_strain, T(plastic_strain + x));
  // Plastic work by the trapezoidal rule in the Kirchhoff stress, exact for linear hardening: strength before and after the step, at the
  // rate of the step.
  const T work = 0.5 * x * J * (map.rate_factor(x).value * start.value / growth_of(in) + end);
  put(state, &State::plastic_work, T(get(state, &State::plastic_work) + work));
  return stress_with(trial, J, remaining, c);
}
template Mat3 VonMises::update(const Increment&, State&, const Constants&) const noexcept;
template Mat3Of<SimdReal> VonMises::update(const IncrementOf<SimdReal>&, StateLanes<State>&, const Constants&) const noexcept;

Real VonMises::yield(const Mat3& stress, const State& state) const noexcept { return yield(stress, state, state.plastic_strain); }
Real VonMises::yield(const Mat3& stress, const State& state, Real softened_at) const noexcept
{
  return talus::von_mises(stress) - flow_stress(state.plastic_strain, 0, softened_at);
}

}  // namespace talus
