#include "materials/von_mises.hpp"

#include "materials/radial_return.hpp"
#include "materials/scalar_root.hpp"

namespace talus {

namespace {

/// The strength in slow loading at a plastic strain, computed fast near the value before the step; its slope is that at positive plastic
/// strain.
template <class T>
struct Hardening {
  const VonMises& law;
  PowerNear<T> gain;

  Hardening(const VonMises& of, const BinomialSeries& binomial, const T& plastic_strain) noexcept
      : law(of), gain(of.power ? plastic_strain : T(0), binomial)
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
    return strength;
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
    return positive_root<T>(*this, (mises - start.value) / stiffness, (mises - going_on) / (stiffness + start.slope), yields);
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
          .closed_form = !voce && !power && !rate,
          .rate_inverse = rate ? 1 / rate->reference_rate : 0,
          .rate_power = rate ? 1 / rate->exponent : 1,
          .power = power ? power->exponent : 1};
}

Real VonMises::flow_stress(Real plastic_strain, Real plastic_rate) const noexcept
{
  const Real factor = rate ? 1 + std::pow(plastic_rate / rate->reference_rate, 1 / rate->exponent) : 1;
  return Hardening<Real>(*this, constants().power, plastic_strain)(plastic_strain).value * factor;
}

void VonMises::divide_strength(Real factor) noexcept
{
  yield_stress /= factor;
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
  const Hardening<T> slow(*this, c.power, plastic_strain);
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

Real VonMises::yield(const Mat3& stress, const State& state) const noexcept
{
  return talus::von_mises(stress) - flow_stress(state.plastic_strain, 0);
}

}  // namespace talus
