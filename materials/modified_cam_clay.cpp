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
template <class T>
struct Ending {
  T p, q, compaction;
  friend Ending where(const MaskOf<T>& condition, const Ending& a, const Ending& b) noexcept
  {
    return {where(condition, a.p, b.p), where(condition, a.q, b.q), where(condition, a.compaction, b.compaction)};
  }
};

/// The return by backward Euler from a trial state outside the ellipse, with one unknown.  With the compaction x of the step
///     p = p(compression - x),   pc = start exp(x / plastic),   q = q_trial / (1 + 6 G m / M^2),   multiplier m = x / (2 p - pc).
/// On either side of the critical state x runs from 0 to where 2 p = pc; m increases from 0 to infinity and q decreases to 0, so the
/// ellipse is crossed in between.
template <class T>
struct EllipseReturn {
  const ModifiedCamClay::Constants& c;
  T compression, q_trial, start;
  Real slope2 = c.slope * c.slope, shear_rate = 6 * c.shear / slope2;

  T preconsolidation_after(const T& compaction) const noexcept
  {
    using std::exp;
    return start * exp(T(compaction / c.plastic));
  }
  /// The value of q^2 / M^2 + p (p - pc) at |x| = size, and its slope; x is negative beyond the critical state.
  ValueAndSlopeOf<T> excess(const T& sign, const T& size) const noexcept
  {
    using std::isfinite;
    const T x = sign * size;
    const T p = c.pressure(T(compression - x)), pc = preconsolidation_after(x), h = 2 * p - pc;
    const T p_slope = -(p + c.reference) / c.swelling, pc_slope = pc / c.plastic, h_slope = 2 * p_slope - pc_slope;
    const auto bounded = isfinite(T(p * p)), before_end = sign * h > 0, regular = bounded && before_end;
    const T below = where(regular, h + shear_rate * x, 1), q = q_trial * (h / below);
    const T q_slope = q_trial * shear_rate * (x * h_slope - h) / (below * below);
    const T value = q * q / slope2 + p * (p - pc), slope = sign * (2 * q * q_slope / slope2 + p_slope * h - p * pc_slope);
    constexpr Real no_slope = std::numeric_limits<Real>::quiet_NaN();
    return {where(regular, value, where(bounded, -pc * pc, p)), where(regular, slope, no_slope)};
  }

  /// Found in the lanes of `yields`; the others have no meaning.
  Ending<T> operator()(const MaskOf<T>& yields) const noexcept
  {
    using std::abs, std::isfinite, std::log1p, std::max, std::min, std::sqrt;
    // At this compaction 2 p equals the preconsolidation before the step: at the critical state or beyond it.
    const T end = compression - c.swelling * log1p(T(start / (2 * c.reference)));
    const T sign = where(end < 0, T(-1), T(1));
    const auto off_critical = yields && !(end == 0);
    T x = 0;
    if (any_of(off_critical)) {
      const ValueAndSlopeOf<T> first = excess(sign, 0);
      T size = positive_root<T>([&](const T& y) { return excess(sign, y); }, abs(end), -first.value / first.slope, off_critical);
      // The error of the root finder, 1e-12 of the root, is larger than a pressure that has become many orders smaller.
      const T left = c.pressure(T(compression - sign * size));
      constexpr int more = 2;
      for (int i = 0; i < more; ++i) {
        const auto rough = off_critical && size * (left + c.reference) > c.swelling * left;
        if (!any_of(rough))
          break;
        const ValueAndSlopeOf<T> last = excess(sign, size);
        size = where(rough && isfinite(last.slope), size - last.value / last.slope, size);
      }
      x = where(off_critical, sign * size, 0);
    }
    const T p = c.pressure(T(compression - x)), pc = preconsolidation_after(x), h = 2 * p - pc;
    // Near the critical state x and h are both small, so q is computed from the ellipse; near the ends of the ellipse from the flow.
    const auto near = abs(h) < 0.5 * pc;
    const T q = where(near, c.slope * sqrt(where(near, p * (pc - p), T(0))), q_trial * (h / where(near, T(1), h + shear_rate * x)));
    return {p, min(q, q_trial), x};
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

template <class T>
Mat3Of<T> ModifiedCamClay::update(const IncrementOf<T>& in, StateOf<T, State>& state, const Constants& c) const noexcept
{
  using std::max;
  const T J = in.F.determinant();
  const ElasticTrial<T> trial(in, get(state, &State::elastic_left));
  if (!all_of(J > 0 && trial.is_finite()))
    return no_answer_somewhere(*this, in, state, c);
  if (in.elastic) {
    put(state, &State::elastic_left, trial.left);
    return unpack(scale_and_shift(2 * c.shear / J, trial.shear_strain, -c.pressure(T(-trial.volume_strain)) / J));
  }
  const T opened = get(state, &State::opened_volume);
  const T compression = -trial.volume_strain - opened;  // opened volume closes first
  const auto loose = compression <= no_compression;
  put(state, &State::opened_volume, max(T(-compression), T(0)));

  const T plastic_volume = get(state, &State::plastic_volume);
  const T start = c.preconsolidation_at(plastic_volume), q_trial = 3 * c.shear * trial.shear;
  Ending<T> end{where(loose, T(0), c.pressure(compression)), where(loose, T(0), q_trial), 0};
  const auto yields = !loose && !(end.p <= start && q_trial * q_trial <= c.slope * c.slope * end.p * (start - end.p));
  if (any_of(yields)) {
    const EllipseReturn<T> map{c, where(yields, compression, 0), where(yields, q_trial, 0), start};
    end = where(yields, map(yields), end);
  }
  const T remaining = where(q_trial > 0, end.q / above_nothing(q_trial), 0);
  Sym3Of<T> left = trial.left;
  if (const auto changed = yields || loose || opened > 0; any_of(changed)) {
    const Sym3Of<T> strain = scale_and_shift(2 * remaining, trial.shear_strain, -2 * (compression - end.compaction) / 3);
    left = where<T>(changed, where<T>(loose, Sym3Of<T>::Zero(), expm1(strain)), left);
  }
  put(state, &State::elastic_left, left);
  const T sheared = (q_trial - end.q) / (3 * c.shear);
  const T work = max(T(end.p * end.compaction + end.q * sheared), T(0));  // p pc times the multiplier, up to round-off
  put(state, &State::plastic_volume, T(plastic_volume - end.compaction));
  put(state, &State::plastic_strain, T(get(state, &State::plastic_strain) + where(loose, trial.shear, sheared)));
  put(state, &State::plastic_work, T(get(state, &State::plastic_work) + work));
  const Sym3Of<T> stress = scale_and_shift(2 * c.shear * remaining / J, trial.shear_strain, -end.p / J);
  return unpack(where<T>(loose, Sym3Of<T>::Zero(), stress));
}
template Mat3 ModifiedCamClay::update(const Increment&, State&, const Constants&) const noexcept;
template Mat3Of<SimdReal> ModifiedCamClay::update(const IncrementOf<SimdReal>&, StateLanes<State>&, const Constants&) const noexcept;

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

template <class T>
T ModifiedCamClay::wave_speed(const Mat3Of<T>&, const StateOf<T, State>& state, const Constants& c) const noexcept
{
  using std::max, std::sqrt;
  const Sym3Of<T> strain = scale_and_shift(0.5, log1p(get(state, &State::elastic_left)), 0);
  const T p = c.pressure(T(-trace(strain)));
  const T shear = sqrt(squared_norm(add_diagonal(strain, T(-trace(strain) / 3))));
  return sqrt(T(((p + c.reference) / c.swelling + max(p, T(0)) + c.shear * (4.0 / 3 + 2 * shear)) / density));
}
template Real ModifiedCamClay::wave_speed(const Mat3&, const State&, const Constants&) const noexcept;
template SimdReal ModifiedCamClay::wave_speed(const Mat3Of<SimdReal>&, const StateLanes<State>&, const Constants&) const noexcept;

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
