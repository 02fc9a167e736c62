#include "materials/johnson_cook.hpp"

#include <fmt/format.h>

#include "materials/radial_return.hpp"
#include "materials/scalar_root.hpp"

namespace talus {

namespace {

using MetalConstants = JohnsonCookMetal::Constants;

Real homologous(const JohnsonCookMetal& metal, Real temperature, const MetalConstants& c) noexcept
{
  return std::clamp((temperature - metal.room_temperature) * c.range_inverse, Real{0}, Real{1});
}

/// Strength [Pa of Cauchy stress], or what it gains.
struct Strength {
  Real value, by_strain, by_temperature;
};

/// Strength at slow rates, fast near the state before the step.
struct SlowStrength {
  const JohnsonCookMetal& metal;
  const MetalConstants& c;
  PowerNear hardening, softening;

  SlowStrength(const JohnsonCookMetal& of, const MetalConstants& constants, Real plastic_strain, Real temperature) noexcept
      : metal(of),
        c(constants),
        hardening(plastic_strain, of.hardening_exponent),
        softening(homologous(of, temperature, constants), of.thermal_exponent)
  {}
  /// The slopes are those at positive plastic strain.
  Strength operator()(Real plastic_strain, Real temperature) const noexcept
  {
    const Real heat = homologous(metal, temperature, c);
    const Real gain = metal.hardening_coefficient * hardening(plastic_strain), cold = metal.yield_stress + gain;
    const Real lost = heat > 0 ? softening(heat) : 0;
    const Real lost_slope = heat > 0 && heat < 1 ? metal.thermal_exponent * lost / heat * c.range_inverse : 0;
    return {cold * (1 - lost), metal.hardening_exponent * gain / plastic_strain * (1 - lost), -cold * lost_slope};
  }
};

/// Plastic flow of one step.
struct PlasticFlow {
  Real strain = 0;  ///< plastic
  Real mises = 0;   ///< Cauchy stress at the end [Pa]
  Real work = 0;    ///< per initial volume [J/m^3]
};

/// Backward Euler from a trial stress above the strength before the step.
struct JohnsonCookReturn {
  const JohnsonCookMetal& metal;
  const MetalConstants& c;
  const SlowStrength& slow;
  Strength start;                    ///< before the step
  Real J, J_before;                  ///< at the end of the step and before
  Real mises, stiffness;             ///< Cauchy stress of the trial state and its fall by plastic strain [Pa]
  Real plastic_strain, temperature;  ///< before the step
  Real relative;                     ///< plastic rate over the reference, by plastic strain of the step
  Real tried = 0;                    ///< plastic strain of the step
  ValueAndSlope tried_factor{1, 0};  ///< of its rate

  ValueAndSlope rate_factor(Real x) const noexcept
  {
    const Real rate = relative * x;
    return rate > 1 ? ValueAndSlope{1 + metal.rate_coefficient * std::log(rate), metal.rate_coefficient / x} : ValueAndSlope{1, 0};
  }
  /// Trapezoidal in the Kirchhoff stress: the strength before and after the step, at the rate of the step.
  Real work(Real x, Real factor, Real end) const noexcept { return 0.5 * x * (J_before * factor * start.value + J * end); }

  /// Stress less strength if the plastic strain of the step is x.
  ValueAndSlope operator()(Real x) noexcept
  {
    const ValueAndSlope factor = rate_factor(x);
    tried = x;
    tried_factor = factor;
    const Real heated = temperature + c.heat * work(x, factor.value, mises - stiffness * x);
    const Real heating = 0.5 * c.heat * (J_before * start.value * (factor.value + x * factor.slope) + J * (mises - 2 * stiffness * x));
    const Strength end = slow(plastic_strain + x, heated);
    return {mises - stiffness * x - factor.value * end.value,
            -stiffness - factor.slope * end.value - factor.value * (end.by_strain + end.by_temperature * heating)};
  }
  PlasticFlow flow(const Mat3& stress_before) noexcept
  {
    const Real going_on = std::max(start.value, von_mises(stress_before));  // flow that goes on hardens from there at the same rate
    const Real hardening = start.by_strain + start.by_temperature * c.heat * J * going_on;
    const Real x = positive_root(*this, mises / stiffness, (mises - going_on) / (stiffness + hardening));
    const Real factor = tried_factor.value + tried_factor.slope * (x - tried);  // exact: the last step is 1e-6 of x
    const Real end = std::max(mises - stiffness * x, Real{0});
    return {x, end, work(x, factor, end)};
  }
};

/// Internal energy of one step by the trapezoidal rule, which makes it linear in the pressure at the end.
struct EnergyStep {
  Real volume_change;  ///< by initial volume
  Real rest;           ///< energy at the end, but for the work of the pressure there [J/m^3]

  /// What shear stores is known by the Kirchhoff stress `mises`, mises^2 / (6 G); what it loses is plastic work.
  EnergyStep(const Increment& in, Real change, Real energy_before, Real mises_before, Real mises, Real plastic_work, Real shear) noexcept
      : volume_change(change)
  {
    const Real stored = (mises - mises_before) * (mises + mises_before) / (6 * shear);
    rest = energy_before + stored + plastic_work + (in.stress.trace() / 6 - in.viscous) * volume_change;
  }
  Real energy(Real pressure) const noexcept { return rest - 0.5 * pressure * volume_change; }
  /// A step that compresses by more than 1/gamma is none; its pressure stays finite.
  Real pressure(const MieGruneisenCurve& curve, Real compression) const noexcept
  {
    return (curve.cold_pressure(compression) + curve.gamma * rest) / std::max(1 + 0.5 * curve.gamma * volume_change, 0.5);
  }
};

}  // namespace

Real JohnsonCookDamage::fracture_strain(Real triaxiality, Real relative_rate, Real homologous) const noexcept
{
  constexpr Real least = 1e-6;
  constexpr Real largest_exponent = 100;  // as good as never; keeps zero times infinity away
  const Real by_pressure = d1 + d2 * std::exp(std::min(d3 * triaxiality, largest_exponent));
  const Real by_rate = 1 + d4 * std::log(std::max(relative_rate, Real{1}));
  const Real by_heat = 1 + d5 * homologous;
  return by_pressure > 0 && by_rate > 0 && by_heat > 0 ? std::max(by_pressure * by_rate * by_heat, least) : least;
}

JohnsonCookMetal::Constants JohnsonCookMetal::constants() const noexcept
{
  const Moduli elastic = moduli();
  Constants c{.bulk = elastic.bulk,
              .shear = elastic.shear,
              .heat = heat_fraction / (density * specific_heat),
              .range_inverse = 1 / (melting_temperature - room_temperature),
              .rate_inverse = 1 / reference_rate,
              .curve = {}};
  if (mie_gruneisen) {
    c.curve.emplace(*mie_gruneisen, density);
    c.bulk = c.curve->bulk;
  }
  return c;
}

Real JohnsonCookMetal::flow_stress(Real plastic_strain, Real plastic_rate, Real temperature) const noexcept
{
  const Constants c = constants();
  const Real rate = std::max(plastic_rate / reference_rate, Real{1});
  return SlowStrength(*this, c, plastic_strain, temperature)(plastic_strain, temperature).value * (1 + rate_coefficient * std::log(rate));
}

Mat3 JohnsonCookMetal::update(const Increment& in, const Memory& memory, const Constants& c) const noexcept
{
  const Real J = in.F.determinant();
  const ElasticTrial trial(in, memory.elastic_left);
  if (!(J > 0 && trial.is_finite()))
    return no_answer();
  const bool failed_before = memory.damage && *memory.damage >= 1;
  const Real stiffness = 3 * c.shear / J, mises = stiffness * trial.shear, relative = c.rate_inverse / in.dt;
  const Real temperature = started(memory.temperature);
  PlasticFlow flow{.mises = failed_before ? 0 : mises};
  if (!in.elastic && !failed_before) {
    const SlowStrength slow(*this, c, memory.plastic_strain, temperature);
    if (const Strength start = slow(memory.plastic_strain, temperature); mises > start.value)
      flow = JohnsonCookReturn{*this, c, slow, start, J, J / growth_of(in), mises, stiffness, memory.plastic_strain, temperature, relative}
                 .flow(in.stress);
  }
  memory.plastic_strain += flow.strain;
  memory.plastic_work += flow.work;
  memory.temperature = temperature + c.heat * flow.work;

  Real pressure = -c.bulk * trial.volume_strain / J;
  std::optional<EnergyStep> step;
  if (c.curve && memory.energy) {
    const Real compression = -std::expm1(trial.volume_strain);
    const Real growth = growth_of(in);
    step.emplace(in, (1 - compression) * (1 - 1 / growth), *memory.energy, von_mises(in.stress) * J / growth, J * flow.mises, flow.work,
                 c.shear);
    pressure = step->pressure(*c.curve, compression);
  }

  if (damage && memory.damage && flow.strain > 0) {
    const Real triaxiality = -pressure / std::max(flow.mises, std::numeric_limits<Real>::min());
    const Real strain = damage->fracture_strain(triaxiality, relative * flow.strain, homologous(*this, memory.temperature, c));
    *memory.damage = std::min(*memory.damage + flow.strain / strain, Real{1});
  }
  const bool failed = memory.damage && *memory.damage >= 1;
  if (failed && !failed_before) {
    const auto released = [&](Real cauchy, Real modulus) { return J * cauchy * J * cauchy / (2 * modulus); };
    memory.plastic_work += released(flow.mises, 3 * c.shear) + released(std::min(pressure, Real{0}), c.bulk);
  }
  if (failed) {
    flow.mises = 0;
    pressure = std::max(pressure, Real{0});
  }
  if (step)
    *memory.energy = step->energy(pressure);

  const Real kept = mises > 0 ? flow.mises / mises : 1;
  memory.elastic_left = kept < 1 ? trial.left_with(kept) : trial.left;
  return unpack(scale_and_shift(2 * c.shear * kept / J, trial.shear_strain, -pressure));
}

void JohnsonCookMetal::prestress(const Mat3& stress, Sym3& elastic_left) const noexcept
{
  const Constants c = constants();
  const Real pressure = -stress.trace() / 3;
  const Real volume_strain = c.curve ? std::log1p(-c.curve->compression_at(pressure)) : -pressure / c.bulk;
  elastic_left = elastic_left_of(dev(stress), c.shear, volume_strain);
}

/// rho_0 c^2 = J^2 dp/de + 4 G / 3 - (Kirchhoff deviator)_nn along the direction n of compression, that deviator taken as in uniaxial
/// strain with the same volume; it works on the energy as well, hence 1 + gamma.  Without a curve as in Drucker-Prager.
Real JohnsonCookMetal::wave_speed(const Mat3& F, const Constants& c) const noexcept
{
  const Real J = F.determinant(), shortening = std::max(-std::log(J), Real{0}), shear = 4 * c.shear / 3;
  if (!c.curve)
    return std::sqrt((c.bulk + shear) * (1 + shortening) / density);
  const Real volume = std::min(J, Real{1});
  return std::sqrt((volume * volume * c.curve->stiffness(1 - J) + shear * (1 + (1 + c.curve->gamma) * shortening)) / density);
}

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
