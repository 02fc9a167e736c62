#include "materials/von_mises.hpp"

#include "materials/radial_return.hpp"
#include "materials/scalar_root.hpp"

namespace talus {

namespace {

/// Strength in slow loading by plastic strain, fast near that before the step; the slope is that at positive plastic strain.
struct Hardening {
  const VonMises& law;
  PowerNear gain;

  Hardening(const VonMises& of, Real plastic_strain) noexcept
      : law(of), gain(of.power ? plastic_strain : 0, of.power ? of.power->exponent : 1)
  {}
  ValueAndSlope operator()(Real plastic_strain) const noexcept
  {
    ValueAndSlope strength{law.yield_stress + law.hardening_modulus * plastic_strain, law.hardening_modulus};
    if (law.voce) {
      const Real missing = law.voce->saturation * std::exp(-law.voce->exponent * plastic_strain);
      strength.value += law.voce->saturation - missing;
      strength.slope += law.voce->exponent * missing;
    }
    if (law.power) {
      const Real gained = law.power->coefficient * gain(plastic_strain);
      strength.value += gained;
      strength.slope += law.power->exponent * gained / plastic_strain;
    }
    return strength;
  }
};

/// Backward Euler from a trial stress above the strength before the step.
struct VonMisesReturn {
  const VonMises& law;
  const Hardening& slow;
  ValueAndSlope start;    ///< strength before the step [Pa]
  Real mises, stiffness;  ///< Cauchy stress of the trial state and its fall by plastic strain [Pa]
  Real plastic_strain;    ///< before the step
  Real relative, power;   ///< plastic rate over D, by plastic strain of the step; 1/q

  ValueAndSlope rate_factor(Real x) const noexcept
  {
    if (!law.rate)
      return {1, 0};
    const Real gain = std::pow(relative * x, power);
    return {1 + gain, power * gain / x};
  }
  /// Stress less strength if the plastic strain of the step is x.
  ValueAndSlope operator()(Real x) const noexcept
  {
    const ValueAndSlope end = slow(plastic_strain + x), factor = rate_factor(x);
    return {mises - stiffness * x - end.value * factor.value, -stiffness - end.slope * factor.value - end.value * factor.slope};
  }
  Real plastic_increment(const Mat3& stress_before) const noexcept
  {
    const Real going_on = std::max(start.value, talus::von_mises(stress_before));  // flow that goes on hardens from there at the same rate
    return positive_root(*this, (mises - start.value) / stiffness, (mises - going_on) / (stiffness + start.slope));
  }
};

/// Cauchy stress with the share `kept` of the shear.
Mat3 stress_with(const ElasticTrial& trial, Real J, Real kept, const VonMises::Constants& c) noexcept
{
  return unpack(scale_and_shift(2 * c.shear * kept / J, trial.shear_strain, c.bulk * trial.volume_strain / J));
}

}  // namespace

VonMises::Constants VonMises::constants() const noexcept
{
  const Moduli elastic = moduli();
  return {.bulk = elastic.bulk,
          .shear = elastic.shear,
          .closed_form = !voce && !power && !rate,
          .rate_inverse = rate ? 1 / rate->reference_rate : 0,
          .rate_power = rate ? 1 / rate->exponent : 1};
}

Real VonMises::flow_stress(Real plastic_strain, Real plastic_rate) const noexcept
{
  const Real factor = rate ? 1 + std::pow(plastic_rate / rate->reference_rate, 1 / rate->exponent) : 1;
  return Hardening(*this, plastic_strain)(plastic_strain).value * factor;
}

Mat3 VonMises::update(const Increment& in, State& state, const Constants& c) const noexcept
{
  const Real J = in.F.determinant();
  const ElasticTrial trial(in, state.elastic_left);
  if (!(J > 0 && trial.is_finite()))
    return no_answer();
  const Real stiffness = 3 * c.shear / J, mises = stiffness * trial.shear;  // Cauchy stress by equivalent strain: J stays in the return
  const Hardening slow(*this, state.plastic_strain);
  const ValueAndSlope start = slow(state.plastic_strain);
  if (in.elastic || !(mises > start.value)) {
    state.elastic_left = trial.left;
    return stress_with(trial, J, 1, c);
  }
  const VonMisesReturn map{*this, slow, start, mises, stiffness, state.plastic_strain, c.rate_inverse / in.dt, c.rate_power};
  const Real x = c.closed_form ? (mises - start.value) / (stiffness + hardening_modulus) : map.plastic_increment(in.stress);
  const Real end = mises - stiffness * x;
  state.elastic_left = trial.left_with(end / mises);
  state.plastic_strain += x;
  // Trapezoidal in the Kirchhoff stress, exact for linear hardening: the strength before and after the step, at the rate of the step.
  state.plastic_work += 0.5 * x * J * (map.rate_factor(x).value * start.value / growth_of(in) + end);
  return stress_with(trial, J, end / mises, c);
}

void VonMises::prestress(const Mat3& stress, State& state) const noexcept
{
  const Moduli elastic = moduli();
  state.elastic_left = elastic_left_of(dev(stress), elastic.shear, stress.trace() / (3 * elastic.bulk));
}

Real VonMises::yield(const Mat3& stress, const State& state) const noexcept
{
  return talus::von_mises(stress) - flow_stress(state.plastic_strain, 0);
}

Real VonMises::wave_speed(const Mat3& F, const Constants& c) const noexcept
{
  return std::sqrt((c.bulk + 4 * c.shear / 3) * (1 + std::max(-std::log(F.determinant()), Real{0})) / density);
}

}  // namespace talus
