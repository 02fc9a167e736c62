#include "materials/modified_cam_clay.hpp"

#include <fmt/format.h>

#include "materials/radial_return.hpp"
#include "materials/scalar_root.hpp"

namespace talus {

namespace {

/// The elastic compression [-] below which the material counts as stress-free.  It is the rounding of the strain, so that shear of constant
/// volume from rest does not depend on rounding.
constexpr Real no_compression = 1e-14;

/// Stress invariants [Pa] and plastic compaction [-] at the end of a return.
struct Ending {
  Real p, q, compaction;
};

/// The return by backward Euler from a trial state outside the ellipse, with one unknown.  With the compaction x of the step
///     p = p(compression - x),   pc = start exp(x / plastic),   q = q_trial / (1 + 6 G m / M^2),   multiplier m = x / (2 p - pc).
/// On either side of the critical state x runs from 0 to where 2 p = pc; m increases from 0 to infinity and q decreases to 0, so the
/// ellipse is crossed in between.
struct EllipseReturn {
  const ModifiedCamClay::Constants& c;
  Real compression, q_trial, start;
  Real slope2 = c.slope * c.slope, shear_rate = 6 * c.shear / slope2;

  /// The value of q^2 / M^2 + p (p - pc) at |x| = size, and its slope; x is negative beyond the critical state.
  ValueAndSlope excess(Real sign, Real size) const noexcept
  {
    const Real x = sign * size;
    const Real p = c.pressure(compression - x), pc = start * std::exp(x / c.plastic), h = 2 * p - pc;
    constexpr Real no_slope = std::numeric_limits<Real>::quiet_NaN();
    if (!std::isfinite(p * p))
      return {p, no_slope};
    if (!(sign * h > 0))
      return {-pc * pc, no_slope};
    const Real p_slope = -(p + c.reference) / c.swelling, pc_slope = pc / c.plastic, h_slope = 2 * p_slope - pc_slope;
    const Real below = h + shear_rate * x, q = q_trial * (h / below);
    const Real q_slope = q_trial * shear_rate * (x * h_slope - h) / (below * below);
    return {q * q / slope2 + p * (p - pc), sign * (2 * q * q_slope / slope2 + p_slope * h - p * pc_slope)};
  }

  Ending operator()() const noexcept
  {
    // At this compaction 2 p equals the preconsolidation before the step: at the critical state or beyond it.
    const Real end = compression - c.swelling * std::log1p(start / (2 * c.reference));
    const Real sign = end < 0 ? -1 : 1;
    Real x = 0;
    if (end != 0) {
      const ValueAndSlope first = excess(sign, 0);
      Real size = positive_root([&](Real y) { return excess(sign, y); }, std::abs(end), -first.value / first.slope);
      // The error of the root finder, 1e-12 of the root, is larger than a pressure that has become many orders smaller.
      const Real left = c.pressure(compression - sign * size);
      constexpr int more = 2;
      for (int i = 0; i < more && size * (left + c.reference) > c.swelling * left; ++i) {
        const ValueAndSlope last = excess(sign, size);
        size -= std::isfinite(last.slope) ? last.value / last.slope : 0;
      }
      x = sign * size;
    }
    const Real p = c.pressure(compression - x), pc = start * std::exp(x / c.plastic), h = 2 * p - pc;
    // Near the critical state x and h are both small, so q is computed from the ellipse; near the ends of the ellipse from the flow.
    const Real q = std::abs(h) < 0.5 * pc ? c.slope * std::sqrt(p * (pc - p)) : q_trial * (h / (h + shear_rate * x));
    return {p, std::min(q, q_trial), x};
  }
};

}  // namespace

ModifiedCamClay::Constants ModifiedCamClay::constants() const noexcept
{
  return {.shear = shear_modulus,
          .reference = reference_pressure,
          .preconsolidation = preconsolidation_pressure,
          .slope = critical_state_slope,
          .swelling = swelling_index,
          .plastic = compression_index - swelling_index};
}

Mat3 ModifiedCamClay::update(const Increment& in, State& state, const Constants& c) const noexcept
{
  const Real J = in.F.determinant();
  const ElasticTrial trial(in, state.elastic_left);
  if (!(J > 0 && trial.is_finite()))
    return no_answer();
  if (in.elastic) {
    state.elastic_left = trial.left;
    return unpack(scale_and_shift(2 * c.shear / J, trial.shear_strain, -c.pressure(-trial.volume_strain) / J));
  }
  const bool was_open = state.opened_volume > 0;
  const Real compression = -trial.volume_strain - state.opened_volume;  // opened volume closes first
  state.opened_volume = std::max(-compression, Real{0});
  if (compression <= no_compression) {
    state.elastic_left = Sym3::Zero();
    state.plastic_strain += trial.shear;
    return Mat3::Zero();
  }

  const Real start = c.preconsolidation_at(state.plastic_volume), q_trial = 3 * c.shear * trial.shear;
  Ending end{c.pressure(compression), q_trial, 0};
  const bool yields = !(end.p <= start && q_trial * q_trial <= c.slope * c.slope * end.p * (start - end.p));
  if (yields)
    end = EllipseReturn{c, compression, q_trial, start}();
  const Real remaining = q_trial > 0 ? end.q / q_trial : 0;
  if (yields || was_open)
    state.elastic_left = expm1(scale_and_shift(2 * remaining, trial.shear_strain, -2 * (compression - end.compaction) / 3));
  else
    state.elastic_left = trial.left;
  const Real sheared = (q_trial - end.q) / (3 * c.shear);
  state.plastic_volume -= end.compaction;
  state.plastic_strain += sheared;
  state.plastic_work += std::max(end.p * end.compaction + end.q * sheared, Real{0});  // p pc times the multiplier, up to round-off
  return unpack(scale_and_shift(2 * c.shear * remaining / J, trial.shear_strain, -end.p / J));
}

void ModifiedCamClay::prestress(const Mat3& stress, State& state) const noexcept
{
  const Real p = std::max(-stress.trace() / 3, Real{0}), q = von_mises(stress);
  state.elastic_left = elastic_left_of(dev(stress), shear_modulus, -swelling_index * std::log1p(p / reference_pressure));
  const Real needed = p > 0 ? p + std::pow(q / critical_state_slope, 2) / p : 0;
  if (needed > constants().preconsolidation_at(state.plastic_volume))
    state.plastic_volume = -(compression_index - swelling_index) * std::log(needed / preconsolidation_pressure);
}

Real ModifiedCamClay::yield(const Mat3&, const State& state) const noexcept
{
  const Constants c = constants();
  const Sym3 strain = 0.5 * log1p(state.elastic_left);
  const Real p = c.pressure(-trace(strain)), pc = c.preconsolidation_at(state.plastic_volume);
  const Real q2 = 6 * c.shear * c.shear * squared_norm(add_diagonal(strain, -trace(strain) / 3));
  return (q2 / (c.slope * c.slope) + p * (p - pc)) / pc;
}

Real ModifiedCamClay::wave_speed(const Mat3& F, const Constants& c) const noexcept
{
  const Real compression = std::max(-std::log(F.determinant()), Real{0});
  const Real p = c.pressure(compression);
  return std::sqrt(((p + c.reference) / c.swelling + p + 4 * c.shear / 3 * (1 + compression)) / density);
}

Real ModifiedCamClay::wave_speed(const Mat3&, const State& state, const Constants& c) const noexcept
{
  const Sym3 strain = 0.5 * log1p(state.elastic_left);
  const Real p = c.pressure(-trace(strain));
  const Real shear = std::sqrt(squared_norm(add_diagonal(strain, -trace(strain) / 3)));
  return std::sqrt(((p + c.reference) / c.swelling + std::max(p, Real{0}) + c.shear * (4.0 / 3 + 2 * shear)) / density);
}

void ModifiedCamClay::check(std::vector<std::string>& problems) const
{
  if (!(compression_index > swelling_index))
    problems.push_back(fmt::format("compression_index {} must be above swelling_index {}", compression_index, swelling_index));
}

void ModifiedCamClay::divide_strength(Real factor) noexcept
{
  const Real sine = 3 * critical_state_slope / (6 + critical_state_slope);
  const Real tangent = sine / std::sqrt(1 - sine * sine) / factor, weaker = tangent / std::sqrt(1 + tangent * tangent);
  critical_state_slope = 6 * weaker / (3 - weaker);
}

}  // namespace talus
