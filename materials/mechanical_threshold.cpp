#include "materials/mechanical_threshold.hpp"

#include <fmt/format.h>

#include "materials/parts/radial_return.hpp"
#include "materials/parts/scalar_root.hpp"

namespace talus {

namespace {

using ThresholdConstants = ThresholdMetal::Constants;

/// The plastic strain [-] below which a step counts as elastic: without it every loaded particle would creep at rates of 1e-60 1/s.
constexpr Real negligible_flow = 1e-12;

/// a^n for a >= 0, without logarithm for the exponents that are customary.
template <class T>
T simple_power(const T& a, Real n) noexcept
{
  using std::pow, std::sqrt;
  return n == 1 ? a : n == 1.5 ? T(a * sqrt(a)) : n == 2 ? T(a * a) : pow(a, n);
}
template <class T>
Jet<T> simple_power(const Jet<T>& a, Real n) noexcept
{
  const T power = simple_power(a.value, n);
  return Jet<T>::chain(power, n * power / above_nothing(a.value), a);
}

/// Rate and temperature, and what follows from them, all with slopes.
template <class T>
struct Activation {
  using N = Jet<T>;
  N log_rate;     ///< [ln 1/s]
  N rate;         ///< [1/s]
  N temperature;  ///< [K]
  N softening;    ///< mu(T) / mu_0
  N energy;       ///< k T / (mu b^3)

  Activation(const ThresholdMetal& metal, const N& log_of_rate, const N& rate_itself, const N& kelvin) noexcept
      : log_rate(log_of_rate),
        rate(rate_itself),
        temperature(kelvin),
        softening(clamped(1 - metal.shear_loss / metal.shear_at_zero_kelvin / (exp(metal.shear_temperature / kelvin) - 1), least, 1)),
        energy(metal.boltzmann_over_burgers_cubed / metal.shear_at_zero_kelvin * kelvin / softening)
  {}
  /// The share of a threshold that is left.
  N share(const ThresholdMetal::Barrier& barrier) const noexcept
  {
    const N work = clamped(energy * barrier.energy_inverse * (barrier.log_rate - log_rate), 0, 1);
    return simple_power(N(1) - simple_power(work, barrier.q_inverse), barrier.p_inverse);
  }

 private:
  static constexpr Real least = 1e-3;  // Varshni's formula is not meant for the temperatures at which it ends
};

template <class T>
Jet<T> strength_of(const ThresholdMetal& metal, const ThresholdConstants& c, const Jet<T>& threshold_ratio,
                   const Activation<T>& at) noexcept
{
  Jet<T> stress = at.share(c.evolving) * threshold_ratio * T(metal.saturation_stress);
  if (c.intrinsic_threshold > 0)
    stress = stress + at.share(c.intrinsic) * T(c.intrinsic_threshold);
  return stress * at.softening + T(metal.athermal_stress);
}

/// The threshold after the plastic strain x of a step.  With X = sigma_e / sigma_es, v = a (1 - X) and w(v) = sinh(v) exp(-v tanh(a)) the
/// equation d sigma_e / dx = theta_0 (1 - tanh(a X) / tanh(a)) has at constant rate and temperature the integral
///     w(v) = w(v before) exp(-x a theta_0 / (sigma_es sinh(a) cosh(a))).
/// w increases and is concave for v <= 2 a, with w(v) <= v, so Newton's method from the left converges from below.
template <class T>
Jet<T> evolved(const ThresholdMetal& metal, const ThresholdConstants& c, const T& ratio, const Jet<T>& x, const Activation<T>& at) noexcept
{
  using std::abs, std::exp, std::expm1, std::max;
  constexpr Real farthest = -20;  // far beyond saturation 1 - tanh(a X) is constant
  constexpr int enough = 60;
  const Real a = metal.hardening_shape, t = c.tanh_shape;
  const Jet<T> saturation = exp(at.energy * T(1 / metal.saturation_energy) * (at.log_rate - T(c.log_saturation_rate)));
  Jet<T> slope =
      at.log_rate * T(metal.hardening_by_log_rate) + T(metal.hardening_modulus) - at.temperature * T(metal.hardening_by_temperature);
  if (metal.hardening_by_root_rate > 0)
    slope = slope + sqrt(at.rate) * T(metal.hardening_by_root_rate);
  const Jet<T> decay = x * clamped(slope, 0, HUGE_VAL) / saturation * T(a * c.inverse_cosh_2 / (t * metal.saturation_stress));
  const Jet<T> start = clamped(a * (1 - ratio / saturation), farthest, a);

  struct Curve {
    T w, slope;
  };
  const auto curve = [&](const T& v) -> Curve {
    const T rising = exp(T((1 - t) * v)), falling = exp(T(-(1 + t) * v));
    return {0.5 * (rising - falling), 0.5 * ((1 - t) * rising + (1 + t) * falling)};
  };
  const Curve before = curve(start.value);
  const T left = exp(T(-decay.value)), aim = before.w * left;
  T v = start.value;
  Curve end = before;
  T missing = before.w * expm1(T(-decay.value));
  for (int i = 0; i < enough; ++i) {
    const T next = max(T(v + missing / end.slope), aim), change = abs(next - v);
    v = next;
    end = curve(v);
    if (all_of(change <= 1e-7 * abs(v - start.value) + 1e-15))
      break;
    missing = aim - end.w;
  }
  Jet<T> moved(v - start.value);
  for (std::size_t k = 0; k < moved.slope.size(); ++k)
    moved.slope[k] = -(start.slope[k] * (end.slope - before.slope * left) + decay.slope[k] * aim) / end.slope;
  return ratio - saturation * moved * T(1 / a);
}

/// Results of the plastic flow of one step.
template <class T>
struct ThresholdFlow {
  T strain = 0;  ///< plastic strain of the step [-]
  T mises = 0;   ///< Cauchy stress at the end [Pa]
  T work = 0;    ///< plastic work per initial volume [J/m^3]
  T ratio = 0;   ///< sigma_e at the end over saturation_stress
};

/// The return by backward Euler from a trial stress above the athermal one.
template <class T>
struct ThresholdReturn {
  const ThresholdMetal& metal;
  const ThresholdConstants& c;
  T J, J_before;                   ///< volume ratios at the end of the step and before
  T mises, stiffness;              ///< von Mises stress (Cauchy) of the trial state and its decrease per plastic strain [Pa]
  T ratio, temperature;            ///< before the step
  Real dt;                         ///< [s]
  T tried = 0;                     ///< last plastic strain of the step that was tried
  Jet<T> work = T(0), end = T(0);  ///< plastic work and sigma_e that belong to it

  /// The strength at the rate of negligible flow, which neither hardens nor heats.
  T least_strength() const noexcept
  {
    const Real rate = negligible_flow / dt;
    return strength_of<T>(metal, c, Jet<T>(ratio), {metal, Jet<T>(std::log(rate)), Jet<T>(rate), temperature}).value;
  }
  /// Stress minus strength for the plastic strain of the step.
  ValueAndSlopeOf<T> operator()(const T& strain) noexcept
  {
    const Jet<T> x = Jet<T>::unknown(strain), rate = x * T(1 / dt), log_rate = log(rate), stress = mises - stiffness * x;
    // The work by the trapezoidal rule in the Kirchhoff stress: strength before and after the step, at the rate of the step.
    const Jet<T> before = strength_of<T>(metal, c, Jet<T>(ratio), {metal, log_rate, rate, temperature});
    work = x * T(0.5) * (J_before * before + J * stress);
    const Activation<T> at(metal, log_rate, rate, temperature + c.heat * work);
    end = evolved(metal, c, ratio, x, at);
    tried = strain;
    const Jet<T> excess = stress - strength_of<T>(metal, c, end, at);
    return {excess.value, excess.slope[0]};
  }
  ThresholdFlow<T> flow(const Mat3Of<T>& stress_before, const MaskOf<T>& flows) noexcept
  {
    using std::max;
    // Continuing flow hardens from the present stress at the same rate.
    const T guess = (mises - von_mises(stress_before)) / (stiffness + metal.hardening_modulus);
    const T x = positive_root<T>(*this, mises / stiffness, guess, flows), last = x - tried;  // the last step is 1e-6 of x
    return {x, max(T(mises - stiffness * x), T(0)), work.value + work.slope[0] * last, max(T(end.value + end.slope[0] * last), T(0))};
  }
};

}  // namespace

ThresholdMetal::Constants ThresholdMetal::constants() const noexcept
{
  const IntrinsicBarrier inner = intrinsic.value_or(IntrinsicBarrier{0, 1, 1, 1, 1});
  const Real cosh = std::cosh(hardening_shape);
  return {metal_constants(),
          {1 / activation_energy, std::log(activation_rate), 1 / activation_p, 1 / activation_q},
          {1 / inner.activation_energy, std::log(inner.activation_rate), 1 / inner.activation_p, 1 / inner.activation_q},
          inner.threshold,
          std::log(saturation_rate),
          std::tanh(hardening_shape),
          1 / (cosh * cosh)};
}

void ThresholdMetal::divide_strength(Real factor) noexcept
{
  for (Real* stress : {&athermal_stress, &hardening_modulus, &hardening_by_log_rate, &hardening_by_root_rate, &hardening_by_temperature,
                       &saturation_stress, &initial_threshold})
    *stress /= factor;
  if (intrinsic)
    intrinsic->threshold /= factor;
}

Real ThresholdMetal::flow_stress(Real threshold_ratio, Real plastic_rate, Real temperature) const noexcept
{
  using J = Jet<Real>;
  return strength_of<Real>(*this, constants(), J(threshold_ratio), {*this, J(std::log(plastic_rate)), J(plastic_rate), J(temperature)})
      .value;
}

Real ThresholdMetal::threshold(Real threshold_ratio, Real temperature) const noexcept
{
  return flow_stress(threshold_ratio, HUGE_VAL, temperature);
}

template <class T>
std::optional<Mat3Of<T>> ThresholdMetal::update(const IncrementOf<T>& in, Memory<T>& memory, const Constants& c) const noexcept
{
  using std::expm1;
  const T J = in.F.determinant();
  const ElasticTrial<T> trial(in, memory.elastic_left);
  if (!all_of(J > 0 && trial.is_finite()))
    return {};
  const T stiffness = 3 * c.shear / J, mises = stiffness * trial.shear, growth = growth_of(in);
  const T temperature = started(memory.temperature);
  memory.threshold_ratio = where(memory.temperature > 0, memory.threshold_ratio, initial_threshold / saturation_stress);
  ThresholdFlow<T> flow{.mises = mises, .ratio = memory.threshold_ratio};
  if (!in.elastic && any_of(mises > athermal_stress)) {
    ThresholdReturn<T> map{*this, c, J, J / growth, mises, stiffness, memory.threshold_ratio, temperature, in.dt};
    if (const auto flows = mises > athermal_stress && mises > map.least_strength(); any_of(flows)) {
      const ThresholdFlow<T> found = map.flow(in.stress, flows);
      flow = {where(flows, found.strain, 0), where(flows, found.mises, mises), where(flows, found.work, 0),
              where(flows, found.ratio, memory.threshold_ratio)};
    }
  }
  memory.plastic_strain += flow.strain;
  memory.plastic_work += flow.work;
  memory.temperature = temperature + c.heat * flow.work;
  memory.threshold_ratio = flow.ratio;

  T pressure = -c.bulk * trial.volume_strain / J;
  if (c.curve && memory.keeps_energy) {
    const T compression = -expm1(trial.volume_strain);
    const EnergyStep<T> step(in, (1 - compression) * (1 - 1 / growth), memory.energy, von_mises(in.stress) * J / growth, J * flow.mises,
                             flow.work, c.shear);
    pressure = step.pressure(*c.curve, compression);
    memory.energy = step.energy(pressure);
  }
  const T remaining = where(mises > 0, flow.mises / above_nothing(mises), 1);
  const auto changed = remaining < 1;
  memory.elastic_left = any_of(changed) ? where(changed, trial.left_with(remaining), trial.left) : trial.left;
  return unpack(scale_and_shift(2 * c.shear * remaining / J, trial.shear_strain, -pressure));
}
template std::optional<Mat3> ThresholdMetal::update(const Increment&, Memory<Real>&, const Constants&) const noexcept;
template std::optional<Mat3Of<SimdReal>> ThresholdMetal::update(const IncrementOf<SimdReal>&, Memory<SimdReal>&,
                                                                const Constants&) const noexcept;

void ThresholdMetal::check(std::vector<std::string>& problems) const
{
  Elasticity::check(problems);
  const Real lost = shear_loss / std::expm1(shear_temperature / initial_temperature);
  if (!(lost < shear_at_zero_kelvin))
    problems.push_back(fmt::format("at initial_temperature {} mu(T) = mu_0 - {:.6g} Pa is not above zero: there would be no strength",
                                   initial_temperature, lost));
  if (!(hardening_modulus > hardening_by_temperature * initial_temperature))
    problems.push_back(fmt::format("hardening_modulus {} is not above hardening_by_temperature times initial_temperature: it would soften",
                                   hardening_modulus));
}

}  // namespace talus
