#include "materials/johnson_cook.hpp"

#include <fmt/format.h>

#include "materials/parts/radial_return.hpp"
#include "materials/parts/scalar_root.hpp"

namespace talus {

namespace {

using JohnsonCookConstants = JohnsonCookMetal::Constants;

template <class T>
T homologous(const JohnsonCookMetal& metal, const T& temperature, const JohnsonCookConstants& c) noexcept
{
  using std::max, std::min;
  return min(max(T((temperature - metal.room_temperature) * c.range_inverse), T(0)), T(1));
}

/// A lower bound of the strength [Pa of Cauchy stress] at any plastic strain, without powers; most metal is below it or flows.
template <class T>
T least_strength(const JohnsonCookMetal& metal, const T& temperature, const JohnsonCookConstants& c) noexcept
{
  const T heat = homologous(metal, temperature, c);
  return metal.yield_stress * (1 - where(heat > 0, metal.thermal_exponent >= 1 ? heat : T(1), T(0)));
}

/// Strength [Pa of Cauchy stress], or its slope.
template <class T>
struct Strength {
  T value, by_strain, by_temperature;
};

/// The strength at slow rates, evaluated fast near the state before the step and near the last one that was evaluated in full.
template <class T>
struct SlowStrength {
  const JohnsonCookMetal& metal;
  const JohnsonCookConstants& c;
  PowerNear<T> hardening, softening;

  SlowStrength(const JohnsonCookMetal& of, const JohnsonCookConstants& constants, const T& plastic_strain, const T& temperature) noexcept
      : metal(of),
        c(constants),
        hardening(plastic_strain, constants.hardening),
        softening(homologous(of, temperature, constants), constants.softening)
  {}
  /// The strength; its slopes are those at positive plastic strain.
  Strength<T> operator()(const T& plastic_strain, const T& temperature) noexcept
  {
    const T heat = homologous(metal, temperature, c);
    const T gain = metal.hardening_coefficient * hardening.advance(plastic_strain), cold = metal.yield_stress + gain;
    T lost = 0, lost_slope = 0;
    if (const auto warm = heat > 0; any_of(warm)) {
      lost = where(warm, softening.advance(heat), 0);
      lost_slope = where(warm && heat < 1, metal.thermal_exponent * lost / above_nothing(heat) * c.range_inverse, 0);
    }
    const T hardens = metal.hardening_exponent * gain / above_nothing(plastic_strain) * (1 - lost);
    return {cold * (1 - lost), where(plastic_strain > 0, hardens, infinitely_steep), -cold * lost_slope};
  }
};

/// Results of the plastic flow of one step.
template <class T>
struct PlasticFlow {
  T strain = 0;  ///< plastic strain of the step [-]
  T mises = 0;   ///< Cauchy stress at the end [Pa]
  T work = 0;    ///< plastic work per initial volume [J/m^3]
};

/// The return by backward Euler from a trial stress above the strength before the step.
template <class T>
struct JohnsonCookReturn {
  const JohnsonCookMetal& metal;
  const JohnsonCookConstants& c;
  SlowStrength<T>& slow;
  Strength<T> start;                      ///< strength before the step
  T J, J_before;                          ///< volume ratios at the end of the step and before
  T mises, stiffness;                     ///< von Mises stress (Cauchy) of the trial state and its decrease per plastic strain [Pa]
  T plastic_strain, temperature;          ///< values before the step
  Real relative;                          ///< plastic rate over the reference rate, per plastic strain of the step
  T tried = 0;                            ///< last plastic strain of the step that was tried
  ValueAndSlopeOf<T> tried_factor{1, 0};  ///< factor of its rate

  ValueAndSlopeOf<T> rate_factor(const T& x) const noexcept
  {
    using std::log, std::max;
    const T rate = relative * x;
    const auto fast = rate > 1;
    if (!any_of(fast))
      return {1, 0};
    return {1 + metal.rate_coefficient * log(max(rate, T(1))), where(fast, metal.rate_coefficient / above_nothing(x), 0)};
  }
  /// The plastic work by the trapezoidal rule in the Kirchhoff stress: strength before and after the step, at the rate of the step.
  T work(const T& x, const T& factor, const T& end) const noexcept { return 0.5 * x * (J_before * factor * start.value + J * end); }

  /// Stress minus strength for the plastic strain x of the step.
  ValueAndSlopeOf<T> operator()(const T& x) noexcept
  {
    const ValueAndSlopeOf<T> factor = rate_factor(x);
    tried = x;
    tried_factor = factor;
    const T heated = temperature + c.heat * work(x, factor.value, mises - stiffness * x);
    const T heating = 0.5 * c.heat * (J_before * start.value * (factor.value + x * factor.slope) + J * (mises - 2 * stiffness * x));
    const Strength<T> end = slow(plastic_strain + x, heated);
    return {mises - stiffness * x - factor.value * end.value,
            -stiffness - factor.slope * end.value - factor.value * (end.by_strain + end.by_temperature * heating)};
  }
  PlasticFlow<T> flow(const Mat3Of<T>& stress_before, const MaskOf<T>& flows) noexcept
  {
    using std::max;
    const T going_on = max(start.value, von_mises(stress_before));  // continuing flow hardens from the present stress at the same rate
    const T hardening = start.by_strain + start.by_temperature * c.heat * J * going_on;
    const T x = positive_root<T>(*this, mises / stiffness, (mises - going_on) / (stiffness + hardening), flows);
    const T factor = tried_factor.value + tried_factor.slope * (x - tried);  // exact: the last step is 1e-6 of x
    const T end = max(T(mises - stiffness * x), T(0));
    return {x, end, work(x, factor, end)};
  }
};

}  // namespace

template <class T>
T JohnsonCookDamage::fracture_strain(const std::type_identity_t<T>& triaxiality, const std::type_identity_t<T>& relative_rate,
                                     const std::type_identity_t<T>& homologous) const noexcept
{
  using std::exp, std::log, std::max, std::min;
  constexpr Real least = 1e-6;
  constexpr Real largest_exponent = 100;  // practically infinite, but avoids zero times infinity
  const T by_pressure = d1 + d2 * exp(min(T(d3 * triaxiality), T(largest_exponent)));
  const T by_rate = 1 + d4 * log(max(relative_rate, T(1)));
  const T by_heat = 1 + d5 * homologous;
  return where(by_pressure > 0 && by_rate > 0 && by_heat > 0, max(T(by_pressure * by_rate * by_heat), T(least)), least);
}
template Real JohnsonCookDamage::fracture_strain<Real>(const Real&, const Real&, const Real&) const noexcept;
template SimdReal JohnsonCookDamage::fracture_strain<SimdReal>(const SimdReal&, const SimdReal&, const SimdReal&) const noexcept;

JohnsonCookMetal::Constants JohnsonCookMetal::constants() const noexcept
{
  return {metal_constants(), 1 / (melting_temperature - room_temperature), 1 / reference_rate, hardening_exponent, thermal_exponent};
}

Real JohnsonCookMetal::flow_stress(Real plastic_strain, Real plastic_rate, Real temperature) const noexcept
{
  const Constants c = constants();
  const Real rate = std::max(plastic_rate / reference_rate, Real{1});
  return SlowStrength<Real>(*this, c, plastic_strain, temperature)(plastic_strain, temperature).value *
         (1 + rate_coefficient * std::log(rate));
}

template <class T>
std::optional<Mat3Of<T>> JohnsonCookMetal::update(const IncrementOf<T>& in, Memory<T>& memory, const Constants& c) const noexcept
{
  using std::expm1, std::max, std::min;
  const T J = in.F.determinant();
  const ElasticTrial<T> trial(in, memory.elastic_left);
  if (!all_of(J > 0 && trial.is_finite()))
    return {};
  const auto failed_before = memory.damage >= 1;
  const T stiffness = 3 * c.shear / J, mises = stiffness * trial.shear, growth = growth_of(in);
  const Real relative = c.rate_inverse / in.dt;
  const T temperature = started(memory.temperature);
  PlasticFlow<T> flow{.mises = where(failed_before, 0, mises)};
  if (!in.elastic && !all_of(failed_before || mises <= least_strength(*this, temperature, c))) {
    SlowStrength<T> slow(*this, c, memory.plastic_strain, temperature);
    const Strength<T> start = slow(memory.plastic_strain, temperature);
    if (const auto flows = !failed_before && mises > start.value; any_of(flows)) {
      JohnsonCookReturn<T> map{*this, c, slow, start, J, J / growth, mises, stiffness, memory.plastic_strain, temperature, relative};
      const PlasticFlow<T> found = map.flow(in.stress, flows);
      flow = {where(flows, found.strain, 0), where(flows, found.mises, flow.mises), where(flows, found.work, 0)};
    }
  }
  memory.plastic_strain += flow.strain;
  memory.plastic_work += flow.work;
  memory.temperature = temperature + c.heat * flow.work;

  T pressure = -c.bulk * trial.volume_strain / J;
  std::optional<EnergyStep<T>> step;
  if (c.curve && memory.keeps_energy) {
    const T compression = -expm1(trial.volume_strain);
    step.emplace(in, (1 - compression) * (1 - 1 / growth), memory.energy, von_mises(in.stress) * J / growth, J * flow.mises, flow.work,
                 c.shear);
    pressure = step->pressure(*c.curve, compression);
  }

  if (const auto flowing = flow.strain > 0; damage && memory.kept != DamageKept::no && any_of(flowing)) {
    const T triaxiality = -pressure / above_nothing(flow.mises);
    const T strain = damage->fracture_strain<T>(triaxiality, relative * flow.strain, homologous(*this, memory.temperature, c));
    if (memory.kept == DamageKept::averaged)
      memory.local_damage += where(flowing, flow.strain / strain, 0);
    else
      memory.damage = where(flowing, min(T(memory.damage + flow.strain / strain), T(1)), memory.damage);
  }
  if (memory.kept == DamageKept::averaged)  // what has failed does not heal where the mean falls
    memory.damage = max(memory.damage, min(memory.mean_damage, T(1)));
  if (const auto failed = memory.damage >= 1; any_of(failed)) {
    const auto released = [&](const T& cauchy, Real modulus) -> T { return J * cauchy * J * cauchy / (2 * modulus); };
    const T all = released(flow.mises, 3 * c.shear) + released(min(pressure, T(0)), c.bulk);
    memory.plastic_work += where(failed && !failed_before, all, 0);
    flow.mises = where(failed, 0, flow.mises);
    pressure = where(failed, max(pressure, T(0)), pressure);
  }
  if (step)
    memory.energy = step->energy(pressure);

  const T remaining = where(mises > 0, flow.mises / above_nothing(mises), 1);
  const auto changed = remaining < 1;
  memory.elastic_left = any_of(changed) ? where(changed, trial.left_with(remaining), trial.left) : trial.left;
  return unpack(scale_and_shift(2 * c.shear * remaining / J, trial.shear_strain, -pressure));
}
template std::optional<Mat3> JohnsonCookMetal::update(const Increment&, Memory<Real>&, const Constants&) const noexcept;
template std::optional<Mat3Of<SimdReal>> JohnsonCookMetal::update(const IncrementOf<SimdReal>&, Memory<SimdReal>&,
                                                                  const Constants&) const noexcept;

void JohnsonCookMetal::check(std::vector<std::string>& problems) const
{
  Elasticity::check(problems);
  if (!(melting_temperature > room_temperature))
    problems.push_back(fmt::format("melting_temperature {} is not above room_temperature {}", melting_temperature, room_temperature));
  if (initial_temperature && !(*initial_temperature < melting_temperature))
    problems.push_back(fmt::format("initial_temperature {} is not below melting_temperature {}: there would be no strength",
                                   *initial_temperature, melting_temperature));
}

void JohnsonCookDamage::check(std::vector<std::string>& problems) const
{
  if (d3 > 0)
    problems.push_back(fmt::format("d3 {} is above 0: tension would make the metal tougher; mean stress is positive in tension here", d3));
  if (!(d1 + d2 > 0) && !(d2 > 0 && d3 < 0))
    problems.push_back(fmt::format("d1 {} and d2 {} leave no plastic strain before fracture: it fails at once", d1, d2));
  if (!(d5 > -1))
    problems.push_back(fmt::format("d5 {} is not above -1: at some temperature below melting it fails at once", d5));
}

}  // namespace talus
