#include "materials/drucker_prager.hpp"

#include <fmt/format.h>

#include <numbers>

namespace talus {

namespace {

using std::numbers::sqrt3;
constexpr Real never = std::numeric_limits<Real>::infinity();

Real radians(Real degrees) noexcept { return degrees * (std::numbers::pi / 180); }

/// The largest mean stress of the cone [Pa].
template <class T>
T tip(const ConeOf<T>& cone) noexcept
{
  return where(cone.q > 0, cone.k / cone.q, never);
}

/// A stress state by its two invariants, and the plastic multiplier and opening that lead to it from the trial state.
template <class T>
struct Point {
  T mean, tau;            ///< Kirchhoff stress [Pa]
  T multiplier, opening;  ///< plastic multiplier; increment of the opened logarithmic volume
  friend Point where(const MaskOf<T>& condition, const Point& a, const Point& b) noexcept
  {
    return {where(condition, a.mean, b.mean), where(condition, a.tau, b.tau), where(condition, a.multiplier, b.multiplier),
            where(condition, a.opening, b.opening)};
  }
};
/// The return by backward Euler from a trial state outside the yield surface.
template <class T>
struct ReturnMap {
  const DruckerPrager::Constants& c;
  T plastic_strain;    ///< at which the cone is taken
  Real softening_end;  ///< plastic strain at which it has softened; infinite if it is constant during the step
  ConeOf<T> start = c.cone_at(plastic_strain);
  T left = sqrt3 * (softening_end - plastic_strain);  ///< multiplier at which the residual cone is reached
  bool softens = softening_end < never;
  Cone slope = softens ? Cone{c.slope.q / sqrt3, c.slope.k / sqrt3} : Cone{0, 0};  ///< change of the cone per multiplier until then

  ConeOf<T> cone_after(const T& multiplier) const noexcept
  {
    return softens ? c.cone_at(T(plastic_strain + multiplier * (1 / sqrt3))) : start;
  }

  /// Return along the cone: tau decreases by G and the mean stress by K q_psi per multiplier.  While the cone softens linearly the
  /// consistency condition is a m^2 - b m + excess = 0, of which the smallest root is taken; without a root the strength drops to residual
  /// at once.
  Point<T> to_cone(const Point<T>& trial) const noexcept
  {
    using std::max, std::sqrt;
    const T excess = trial.tau + start.q * trial.mean - start.k;
    const Real a = -slope.q * c.bulk * c.q_psi;
    const T b = c.shear + c.bulk * start.q * c.q_psi + slope.k - slope.q * trial.mean;
    const T discriminant = b * b - 4 * a * excess;
    const auto solved = b > 0 && discriminant >= 0;
    T m = where(solved, 2 * excess / (where(solved, b, 1) + sqrt(max(discriminant, T(0)))), never);
    if (!all_of(m <= left))
      m = where(m <= left, m, (trial.tau + c.residual.q * trial.mean - c.residual.k) / (c.shear + c.bulk * c.residual.q * c.q_psi));
    return {trial.mean - c.bulk * c.q_psi * m, trial.tau - c.shear * m, m, 0};
  }

  /// Return by opening to the plane of the cut-off, its edge with the cone, or the tip of the cone.
  Point<T> to_opening(const Point<T>& trial, const T& cutoff) const noexcept
  {
    using std::max;
    const T plane = where(cutoff < never, cutoff, 0);  // avoids zero slope times infinity
    const T excess = trial.tau + start.q * plane - start.k;
    T m = excess / (c.shear + slope.k - slope.q * plane);
    m = where(m >= 0 && m <= left, m, (trial.tau + c.residual.q * plane - c.residual.k) / c.shear);
    m = where(cutoff < never && excess > 0, m, 0);
    const auto on_plane = cutoff < tip(cone_after(m));
    m = where(on_plane, m, trial.tau / c.shear);
    const T mean = where(on_plane, cutoff, tip(cone_after(m)));
    return {mean, max(T(trial.tau - c.shear * m), T(0)), m, (trial.mean - mean) / c.bulk - c.q_psi * m};
  }

  Point<T> operator()(const Point<T>& trial, const T& cutoff) const noexcept
  {
    using std::min;
    Point<T> end = trial;
    if (const auto sheared = trial.tau + start.q * trial.mean - start.k > 0; any_of(sheared))
      end = where(sheared, to_cone(trial), trial);
    if (const auto opens = end.mean > min(cutoff, tip(cone_after(end.multiplier))); any_of(opens))
      end = where(opens, to_opening(trial, cutoff), end);
    return end;
  }
};

}  // namespace

Real DruckerPrager::dilation_slope() const noexcept
{
  const Real sine = std::sin(radians(dilation_angle));
  switch (match) {
    case ConeMatch::outer: return 2 * sqrt3 * sine / (3 - sine);
    case ConeMatch::inner: return 2 * sqrt3 * sine / (3 + sine);
    case ConeMatch::plane_strain: return sqrt3 * sine / std::sqrt(3 + sine * sine);
  }
  return 0;
}

Cone DruckerPrager::cone_of(Real friction, Real soil_cohesion) const noexcept
{
  const Real sine = std::sin(radians(friction)), cosine = std::cos(radians(friction));
  const auto scaled = [&](Real factor) { return Cone{factor * sine, factor * soil_cohesion * cosine}; };
  switch (match) {
    case ConeMatch::outer: return scaled(2 * sqrt3 / (3 - sine));
    case ConeMatch::inner: return scaled(2 * sqrt3 / (3 + sine));
    case ConeMatch::plane_strain: break;
  }
  const Real q_psi = dilation_slope();  // flow without strain out of plane determines the position of the stress on the circle
  return scaled(1 / (std::sqrt(1 - q_psi * q_psi / 3) + q_psi * sine / 3));
}

Cone DruckerPrager::cone(Real plastic_strain) const noexcept { return constants().cone_at(plastic_strain); }

DruckerPrager::Constants DruckerPrager::constants() const noexcept
{
  const Cone peak = cone_of(friction_angle, cohesion);
  const Cone residual = cone_of(softened_friction_angle(), softened_cohesion());
  const Real strain = softening_strain.value_or(never);
  const Moduli elastic = moduli();
  return {.bulk = elastic.bulk,
          .shear = elastic.shear,
          .peak = peak,
          .residual = residual,
          .slope = {(residual.q - peak.q) / strain, (residual.k - peak.k) / strain},
          .softening_strain = strain,
          .q_psi = dilation_slope(),
          .cutoff = tension_cutoff.value_or(never)};
}

template <class T>
Mat3Of<T> DruckerPrager::update(const IncrementOf<T>& in, StateOf<T, State>& state, const Constants& c) const noexcept
{
  using std::isfinite, std::max, std::sqrt;
  const T J = in.F.determinant();
  const Sym3Of<T> b = push_forward(in.dt * in.L, get(state, &State::elastic_left));
  const Sym3Of<T> twice_strain = log1p(b);
  const T volume_strain = 0.5 * trace(twice_strain);
  const Sym3Of<T> shear_strain = scale_and_shift(0.5, twice_strain, -volume_strain / 3);
  Point<T> trial{c.bulk * volume_strain, c.shear * sqrt(T(2 * squared_norm(shear_strain))), 0, 0};
  if (!all_of(J > 0 && isfinite(T(trial.mean + trial.tau))))
    return no_answer_somewhere(*this, in, state, c);
  const T per_volume = 1 / J;
  if (in.elastic) {
    put(state, &State::elastic_left, b);
    return unpack(scale_and_shift(2 * c.shear * per_volume, shear_strain, trial.mean * per_volume));
  }

  // Volume that was opened before closes first; the material has no tension meanwhile.
  const T opened = get(state, &State::opened_volume), plastic_strain = get(state, &State::plastic_strain);
  const auto closing = opened > 0 && trial.mean < 0;
  trial.mean = where(closing, trial.mean + c.bulk * opened, trial.mean);
  const bool constant = in.softened_at != nullptr;
  const ReturnMap<T> map{c, constant ? *in.softened_at : plastic_strain, constant ? never : c.softening_strain};
  const Point<T> end = map(trial, where(closing, T(0), T(c.cutoff)));

  const T remaining = where(trial.tau > 0, end.tau / where(trial.tau > 0, trial.tau, 1), 0);  // avoids 0 / 0 in lanes without shear
  if (const auto changed = closing || end.multiplier > 0 || end.opening > 0; any_of(changed)) {
    const Sym3Of<T> left = expm1(scale_and_shift(2 * remaining, shear_strain, end.mean * (2 / (3 * c.bulk))));
    put(state, &State::elastic_left, where(changed, left, b));
    put(state, &State::plastic_strain, T(plastic_strain + end.multiplier * (1 / sqrt3)));
    const T work = end.tau * end.multiplier + end.mean * (c.q_psi * end.multiplier + end.opening);
    // Associated flow without cohesion dissipates nothing, up to round-off.
    put(state, &State::plastic_work, T(get(state, &State::plastic_work) + max(work, T(0))));
    put(state, &State::opened_volume, T(where(closing, 0, opened) + end.opening));
  } else {
    put(state, &State::elastic_left, b);
  }
  return unpack(scale_and_shift(2 * c.shear * remaining * per_volume, shear_strain, end.mean * per_volume));
}
template Mat3 DruckerPrager::update(const Increment&, State&, const Constants&) const noexcept;
template Mat3Of<SimdReal> DruckerPrager::update(const IncrementOf<SimdReal>&, StateLanes<State>&, const Constants&) const noexcept;

Real DruckerPrager::yield(const Mat3&, const State& state, Real softened_at) const noexcept
{
  const Constants c = constants();
  const Cone now = c.cone_at(softened_at);
  return cone_yield(state, c.bulk, c.shear, now.q, now.k);
}

void DruckerPrager::check(std::vector<std::string>& problems) const
{
  Elasticity::check(problems);
  SoilStrength::check(problems);
  if (tension_cutoff && *tension_cutoff > tip_of_strength())
    problems.push_back(fmt::format("tension_cutoff {} is above the tip of the cone, {:.6g} Pa", *tension_cutoff, tip_of_strength()));
}

void DruckerPrager::divide_strength(Real factor) noexcept
{
  divide_shear_strength(factor);
  divide_cutoff(factor, tip_of_strength());
}

Real DruckerPrager::tip_of_strength() const noexcept { return tip(cone_of(friction_angle, cohesion)); }

}  // namespace talus
