#include "materials/cam_clay.hpp"

#include <fmt/format.h>

#include "materials/cohesive_cam_clay.hpp"
#include "materials/modified_cam_clay.hpp"
#include "materials/parts/radial_return.hpp"
#include "materials/parts/scalar_root.hpp"

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

/// The return by backward Euler from a trial state outside the ellipse, with one unknown.  With the compaction x of the step and b the
/// cohesion
///     p = p(compression - x),   pc = pc(x),   q = q_trial / (1 + 6 G m / slope^2),   multiplier m = x / (2 p - (1 - b) pc).
/// On either side of the critical state x runs from 0 to where 2 p = (1 - b) pc; m increases from 0 to infinity and q decreases to 0, so
/// the ellipse is crossed in between.
template <class T, class Curves>
struct EllipseReturn {
  const Curves& curves;
  T compression, q_trial, start, compacted;
  Real of_ellipse = curves.c.slope, cohesion = curves.c.cohesion, middle = 1 - cohesion;
  Real slope2 = of_ellipse * of_ellipse, shear_rate = 6 * curves.c.shear / slope2;

  T preconsolidation_after(const T& compaction) const noexcept { return curves.preconsolidation_after(compaction, start, compacted); }
  /// The value of q^2 / slope^2 + (p + b pc) (p - pc) at |x| = size, and its slope; x is negative beyond the critical state.
  ValueAndSlopeOf<T> excess(const T& sign, const T& size) const noexcept
  {
    using std::isfinite;
    const T x = sign * size;
    const T p = curves.pressure(T(compression - x)), pc = preconsolidation_after(x), h = 2 * p - middle * pc;
    const T p_slope = -curves.stiffness(p), pc_slope = curves.hardening(pc), h_slope = 2 * p_slope - middle * pc_slope;
    const auto bounded = isfinite(T(p * p)), before_end = sign * h > 0, regular = bounded && before_end;
    const T below = where(regular, h + shear_rate * x, 1), q = q_trial * (h / below);
    const T q_slope = q_trial * shear_rate * (x * h_slope - h) / (below * below);
    const T value = q * q / slope2 + (p + cohesion * pc) * (p - pc);
    const T slope = sign * (2 * q * q_slope / slope2 + p_slope * h - (middle * p + 2 * cohesion * pc) * pc_slope);
    constexpr Real no_slope = std::numeric_limits<Real>::quiet_NaN();
    return {where(regular, value, where(bounded, T(-1), p)), where(regular, slope, no_slope)};
  }

  /// Found in the lanes of `yields`; the others have no meaning.
  Ending<T> operator()(const MaskOf<T>& yields) const noexcept
  {
    using std::abs, std::isfinite, std::max, std::min, std::sqrt;
    // At this compaction p is the middle of the ellipse before the step: at the critical state or beyond it.
    const T end = compression - curves.compression_under(T(0.5 * middle * start));
    const T sign = where(end < 0, T(-1), T(1));
    const auto off_critical = yields && !(end == 0);
    T x = 0;
    if (any_of(off_critical)) {
      const ValueAndSlopeOf<T> first = excess(sign, 0);
      T size = positive_root<T>([&](const T& y) { return excess(sign, y); }, abs(end), -first.value / first.slope, off_critical);
      // The error of the root finder, 1e-12 of the root, is larger than a pressure that has become many orders smaller.
      const T left = curves.pressure(T(compression - sign * size));
      constexpr int more = 2;
      for (int i = 0; i < more; ++i) {
        const auto rough = off_critical && size * curves.stiffness(left) > abs(left);
        if (!any_of(rough))
          break;
        const ValueAndSlopeOf<T> last = excess(sign, size);
        size = where(rough && isfinite(last.slope), size - last.value / last.slope, size);
      }
      x = where(off_critical, sign * size, 0);
    }
    const T p = curves.pressure(T(compression - x)), pc = preconsolidation_after(x), h = 2 * p - middle * pc;
    // Near the critical state x and h are both small, so q is computed from the ellipse; near the ends of the ellipse from the flow.
    const auto near = abs(h) < 0.5 * (1 + cohesion) * pc;
    const T along = of_ellipse * sqrt(where(near, (p + cohesion * pc) * (pc - p), T(0)));
    const T q = where(near, along, q_trial * (h / where(near, T(1), h + shear_rate * x)));
    return {p, min(q, q_trial), x};
  }
};

/// The elastic energy per initial volume [J/m^3] of an elastic left Cauchy-Green tensor minus identity.
template <class T, class Curves>
T stored_energy(const Sym3Of<T>& left, const Curves& curves) noexcept
{
  const Sym3Of<T> strain = scale_and_shift(0.5, log1p(left), 0);
  const T volume = trace(strain);
  return curves.energy(T(-volume)) + curves.c.shear * squared_norm(add_diagonal(strain, T(-volume / 3)));
}

}  // namespace

template <class Curves, class T>
Mat3Of<T> CamClay::update_along(const Curves& curves, const IncrementOf<T>& in, StateOf<T, State>& state) const noexcept
{
  using std::max;
  constexpr bool ends = Curves::ends;
  const Constants& c = curves.c;
  const T J = in.F.determinant();
  const Sym3Of<T> before = get(state, &State::elastic_left);
  const ElasticTrial<T> trial(in, before);
  if (!all_of(J > 0 && trial.is_finite()))
    return no_answer_somewhere(*this, in, state, c);
  if (in.elastic) {
    put(state, &State::elastic_left, trial.left);
    return unpack(scale_and_shift(2 * c.shear / J, trial.shear_strain, -curves.pressure(T(-trial.volume_strain)) / J));
  }
  const T opened = get(state, &State::opened_volume);
  const T compression = -trial.volume_strain - opened;  // opened volume closes first
  const T plastic_volume = get(state, &State::plastic_volume);
  const T start = curves.preconsolidation_at(plastic_volume), p_trial = curves.pressure(compression), q_trial = 3 * c.shear * trial.shear;
  const auto inside = p_trial <= start && q_trial * q_trial <= c.slope * c.slope * ((p_trial + c.cohesion * start) * (start - p_trial));
  // What dilation can take before nothing bears stress.
  const T left_over = ends ? curves.compaction_left(plastic_volume) : T(c.cohesion > 0 ? std::numeric_limits<Real>::infinity() : 0);
  const auto used_up = compression + left_over <= no_compression, loose = ends ? used_up && !inside : used_up;
  const T given_up = ends ? left_over : T(0);
  put(state, &State::opened_volume, where(loose, max(T(-compression - left_over), T(0)), 0));

  Ending<T> end{where(loose, T(0), p_trial), where(loose, T(0), q_trial), where(loose, T(-given_up), 0)};
  const auto yields = !loose && !inside;
  if (any_of(yields)) {
    const EllipseReturn<T, Curves> map{curves, where(yields, compression, 0), where(yields, q_trial, 0), start, given_up};
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
  T work = max(T(end.p * end.compaction + end.q * sheared), T(0));  // up to round-off a positive number times the multiplier
  if (const auto breaks = loose && !(opened > 0); ends && any_of(breaks))
    work = where(breaks, stored_energy(before, curves), work);
  put(state, &State::plastic_volume, T(plastic_volume - end.compaction));
  put(state, &State::plastic_strain, T(get(state, &State::plastic_strain) + where(loose, trial.shear, sheared)));
  put(state, &State::plastic_work, T(get(state, &State::plastic_work) + work));
  const Sym3Of<T> stress = scale_and_shift(2 * c.shear * remaining / J, trial.shear_strain, -end.p / J);
  return unpack(where<T>(loose, Sym3Of<T>::Zero(), stress));
}
#define TALUS_CAM_CLAY_CURVES(linear, sine)                                                                                             \
  template Mat3 CamClay::update_along(const CamClayCurves<linear, sine>&, const Increment&, State&) const noexcept;                     \
  template Mat3Of<SimdReal> CamClay::update_along(const CamClayCurves<linear, sine>&, const IncrementOf<SimdReal>&, StateLanes<State>&) \
      const noexcept;
TALUS_CAM_CLAY_CURVES(false, false)
TALUS_CAM_CLAY_CURVES(false, true)
TALUS_CAM_CLAY_CURVES(true, false)
TALUS_CAM_CLAY_CURVES(true, true)
#undef TALUS_CAM_CLAY_CURVES

void CamClay::start_under(const Mat3& stress, State& state, const Constants& c) noexcept
{
  const Real b = c.cohesion, pressed = -stress.trace() / 3, p = b > 0 ? pressed : std::max(pressed, Real{0}), q = von_mises(stress);
  state.elastic_left = elastic_left_of(dev(stress), c.shear, -c.compression_under(p));
  const auto needed = [&] {  // the p0 whose ellipse passes through p and q
    if (b == 0)
      return p > 0 ? p + std::pow(q / c.slope, 2) / p : 0;
    const Real sum = p * p + std::pow(q / c.slope, 2), half = (1 - b) * p;
    return sum > 0 ? 2 * sum / (half + std::sqrt(half * half + 4 * b * sum)) : 0;
  }();
  if (needed > c.preconsolidation_at(state.plastic_volume))
    state.plastic_volume =
        c.rate > 0 ? c.compacted - std::asinh(needed / c.bulk) / c.rate : -c.plastic * std::log(needed / c.preconsolidation);
}

Real CamClay::yield_of(const State& state, const Constants& c) noexcept
{
  const Sym3 strain = 0.5 * log1p(state.elastic_left);
  const Real p = c.pressure(-trace(strain)), pc = c.preconsolidation_at(state.plastic_volume);
  const Real q2 = 6 * c.shear * c.shear * squared_norm(add_diagonal(strain, -trace(strain) / 3));
  if (!(pc > 0))
    return std::sqrt(q2 / (c.slope * c.slope) + p * p);
  return (q2 / (c.slope * c.slope) + (p + c.cohesion * pc) * (p - pc)) / pc;
}

Real CamClay::wave_speed(const Mat3& F, const Constants& c) const noexcept
{
  const Real compression = std::max(-std::log(F.determinant()), Real{0});
  return c.with_curves([&](const auto& curves) {
    const Real p = curves.pressure(compression);
    return std::sqrt((curves.stiffness(p) + p + 4 * c.shear / 3 * (1 + compression)) / density);
  });
}

template <class T>
T CamClay::wave_speed(const Mat3Of<T>&, const StateOf<T, State>& state, const Constants& c) const noexcept
{
  using std::max, std::sqrt;
  const Sym3Of<T> strain = scale_and_shift(0.5, log1p(get(state, &State::elastic_left)), 0);
  const T shear = sqrt(squared_norm(add_diagonal(strain, T(-trace(strain) / 3))));
  return c.with_curves([&](const auto& curves) {
    const T p = curves.pressure(T(-trace(strain)));
    return sqrt(T((curves.stiffness(p) + max(p, T(0)) + c.shear * (4.0 / 3 + 2 * shear)) / density));
  });
}
template Real CamClay::wave_speed(const Mat3&, const State&, const Constants&) const noexcept;
template SimdReal CamClay::wave_speed(const Mat3Of<SimdReal>&, const StateLanes<State>&, const Constants&) const noexcept;

Real CamClay::slope_over(Real slope, Real factor) noexcept
{
  const Real sine = 3 * slope / (6 + slope);
  const Real tangent = sine / std::sqrt(1 - sine * sine) / factor, weaker = tangent / std::sqrt(1 + tangent * tangent);
  return 6 * weaker / (3 - weaker);
}

ModifiedCamClay::Constants ModifiedCamClay::constants() const noexcept
{
  return {.shear = shear_modulus,
          .reference = reference_pressure,
          .preconsolidation = preconsolidation_pressure,
          .slope = critical_state_slope,
          .swelling = swelling_index,
          .plastic = compression_index - swelling_index,
          .bulk = reference_pressure / swelling_index};
}

void ModifiedCamClay::check(std::vector<std::string>& problems) const
{
  if (!(compression_index > swelling_index))
    problems.push_back(fmt::format("compression_index {} must be above swelling_index {}", compression_index, swelling_index));
}

CohesiveCamClay::Constants CohesiveCamClay::constants() const noexcept
{
  const bool linear = !swelling_index;
  const Moduli elastic = linear ? moduli() : Moduli{};
  const Real kappa = swelling_index.value_or(1), reference = reference_pressure.value_or(0);
  Constants c{.shear = linear ? elastic.shear : shear_modulus.value_or(0),
              .reference = reference,
              .preconsolidation = preconsolidation_pressure,
              .slope = critical_state_slope / std::sqrt(1 + 2 * cohesion_ratio),
              .swelling = kappa,
              .plastic = compression_index.value_or(kappa + 1) - kappa,
              .bulk = linear ? elastic.bulk : reference / kappa,
              .cohesion = cohesion_ratio,
              .rate = hardening_factor.value_or(0),
              .linear = linear};
  if (hardening_factor)
    c.compacted = std::asinh(preconsolidation_pressure / c.bulk) / *hardening_factor;
  return c;
}

void CohesiveCamClay::check(std::vector<std::string>& problems) const
{
  if (cohesion_ratio > 1)
    problems.push_back(fmt::format("cohesion_ratio {} is above 1", cohesion_ratio));
  if (swelling_index.has_value() != reference_pressure.has_value())
    problems.emplace_back("swelling_index and reference_pressure come together");
  if (!swelling_index)
    Elasticity::check(problems);
  else if (!shear_modulus || youngs_modulus || poisson_ratio || bulk_modulus || lame_lambda)
    problems.emplace_back("with swelling_index shear_modulus is the only other elastic constant");
  if (hardening_factor.has_value() == compression_index.has_value())
    problems.emplace_back("hardening is by hardening_factor or by compression_index: give one of them");
  if (compression_index && !(*compression_index > swelling_index.value_or(*compression_index)))
    problems.push_back(swelling_index
                           ? fmt::format("compression_index {} must be above swelling_index {}", *compression_index, *swelling_index)
                           : "compression_index needs swelling_index");
}

}  // namespace talus
