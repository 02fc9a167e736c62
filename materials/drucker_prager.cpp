#include "materials/drucker_prager.hpp"

#include <fmt/format.h>

#include <numbers>

#include "materials/soil_rules.hpp"

namespace talus {

namespace {

using std::numbers::sqrt3;
constexpr Real never = std::numeric_limits<Real>::infinity();

Real radians(Real degrees) noexcept { return degrees * (std::numbers::pi / 180); }

/// Largest mean stress the cone allows.
Real tip(const Cone& cone) noexcept { return cone.q > 0 ? cone.k / cone.q : never; }

/// A state of stress by its two measures, and how it was reached from the trial state.
struct Point {
  Real mean, tau;            ///< Kirchhoff stress [Pa]
  Real multiplier, opening;  ///< plastic multiplier; logarithmic volume that opened
};

/// Backward Euler from a trial state outside the yield surface.
struct ReturnMap {
  const DruckerPrager::Constants& c;
  Real plastic_strain;
  Cone start = c.cone_at(plastic_strain);
  Real left = sqrt3 * (c.softening_strain - plastic_strain);  ///< multiplier until the residual cone
  Cone slope{c.slope.q / sqrt3, c.slope.k / sqrt3};           ///< of the cone by multiplier, while some is left

  Cone cone_after(Real multiplier) const noexcept { return c.cone_at(plastic_strain + multiplier / sqrt3); }

  /// Along the cone, tau falls by G and the mean stress by K q_psi per multiplier.  While the cone shrinks linearly the consistency
  /// condition is a m^2 - b m + excess = 0, of which the smallest root counts; without one the strength drops to residual at once.
  Point to_cone(const Point& trial) const noexcept
  {
    const Real excess = trial.tau + start.q * trial.mean - start.k;
    const Real a = -slope.q * c.bulk * c.q_psi;
    const Real b = c.shear + c.bulk * start.q * c.q_psi + slope.k - slope.q * trial.mean;
    const Real discriminant = b * b - 4 * a * excess;
    Real m = never;
    if (b > 0 && discriminant >= 0)
      m = 2 * excess / (b + std::sqrt(discriminant));
    if (!(m <= left))
      m = (trial.tau + c.residual.q * trial.mean - c.residual.k) / (c.shear + c.bulk * c.residual.q * c.q_psi);
    return {trial.mean - c.bulk * c.q_psi * m, trial.tau - c.shear * m, m, 0};
  }

  /// To the plane of the cut-off, its edge with the cone, or the tip of the cone, by opening.
  Point to_opening(const Point& trial, Real cutoff) const noexcept
  {
    Real m = 0;
    if (const Real excess = trial.tau + start.q * cutoff - start.k; cutoff < never && excess > 0) {
      m = excess / (c.shear + slope.k - slope.q * cutoff);
      if (!(m >= 0 && m <= left))
        m = (trial.tau + c.residual.q * cutoff - c.residual.k) / c.shear;
    }
    Real mean = cutoff;
    if (!(cutoff < tip(cone_after(m)))) {
      m = trial.tau / c.shear;
      mean = tip(cone_after(m));
    }
    return {mean, std::max(trial.tau - c.shear * m, Real{0}), m, (trial.mean - mean) / c.bulk - c.q_psi * m};
  }

  Point operator()(const Point& trial, Real cutoff) const noexcept
  {
    Point end = trial;
    if (trial.tau + start.q * trial.mean - start.k > 0)
      end = to_cone(trial);
    if (end.mean > std::min(cutoff, tip(cone_after(end.multiplier))))
      end = to_opening(trial, cutoff);
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
  const Real q_psi = dilation_slope();  // flow without strain out of plane fixes where on the circle the stress sits
  return scaled(1 / (std::sqrt(1 - q_psi * q_psi / 3) + q_psi * sine / 3));
}

Cone DruckerPrager::cone(Real plastic_strain) const noexcept { return constants().cone_at(plastic_strain); }

DruckerPrager::Constants DruckerPrager::constants() const noexcept
{
  const Cone peak = cone_of(friction_angle, cohesion);
  const Cone residual = cone_of(residual_friction_angle.value_or(friction_angle), residual_cohesion.value_or(cohesion));
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

Mat3 DruckerPrager::update(const Increment& in, State& state, const Constants& c) const noexcept
{
  const Real J = in.F.determinant();
  const Sym3 b = push_forward(in.dt * in.L, state.elastic_left);
  const Sym3 twice_strain = log1p(b);
  const Real volume_strain = 0.5 * trace(twice_strain);
  const Sym3 shear_strain = scale_and_shift(0.5, twice_strain, -volume_strain / 3);
  Point trial{c.bulk * volume_strain, c.shear * std::sqrt(2 * squared_norm(shear_strain)), 0, 0};
  if (!(J > 0 && std::isfinite(trial.mean + trial.tau)))
    return no_answer();
  if (in.elastic) {
    state.elastic_left = b;
    return unpack(scale_and_shift(2 * c.shear / J, shear_strain, trial.mean / J));
  }

  // What opened before fills first, and carries no tension while it does.
  const bool closing = state.opened_volume > 0 && trial.mean < 0;
  if (closing)
    trial.mean += c.bulk * state.opened_volume;
  const ReturnMap map{c, state.plastic_strain};
  const Point end = map(trial, closing ? 0 : c.cutoff);

  const Real kept = trial.tau > 0 ? end.tau / trial.tau : 0;
  if (closing || end.multiplier > 0 || end.opening > 0)
    state.elastic_left = expm1(scale_and_shift(2 * kept, shear_strain, 2 * end.mean / (3 * c.bulk)));
  else
    state.elastic_left = b;
  state.plastic_strain += end.multiplier / sqrt3;
  const Real work = end.tau * end.multiplier + end.mean * (c.q_psi * end.multiplier + end.opening);
  state.plastic_work += std::max(work, Real{0});  // associated flow without cohesion dissipates nothing, up to rounding
  state.opened_volume = (closing ? 0 : state.opened_volume) + end.opening;
  return unpack(scale_and_shift(2 * c.shear * kept / J, shear_strain, end.mean / J));
}

void DruckerPrager::prestress(const Mat3& stress, State& state) const noexcept
{
  const Constants c = constants();
  state.elastic_left = expm1(add_diagonal(pack(dev(stress) / c.shear), 2 * stress.trace() / (9 * c.bulk)));
}

Real DruckerPrager::yield(const Mat3&, const State& state) const noexcept
{
  const Constants c = constants();
  const Sym3 strain = 0.5 * log1p(state.elastic_left);
  const Cone now = c.cone_at(state.plastic_strain);
  const Real tau = c.shear * std::sqrt(2 * squared_norm(add_diagonal(strain, -trace(strain) / 3)));
  return tau + now.q * c.bulk * trace(strain) - now.k;
}

Real DruckerPrager::wave_speed(const Mat3& F, const Constants& c) const noexcept
{
  return std::sqrt((c.bulk + 4 * c.shear / 3) * (1 + std::max(-std::log(F.determinant()), Real{0})) / density);
}

void DruckerPrager::check(std::vector<std::string>& problems) const
{
  Elasticity::check(problems);
  check_softening(*this, problems);
  if (const Real apex = tip(cone_of(friction_angle, cohesion)); tension_cutoff && *tension_cutoff > apex)
    problems.push_back(fmt::format("tension_cutoff {} is above the tip of the cone, {:.6g} Pa", *tension_cutoff, apex));
}

}  // namespace talus
