#include "materials/mohr_coulomb.hpp"

#include <fmt/format.h>

#include <numbers>

#include "materials/radial_return.hpp"

namespace talus {

namespace {

constexpr Real square_root_of_3 = std::numbers::sqrt3;
constexpr Real infinite = std::numeric_limits<Real>::infinity();

Real in_radians(Real degrees) noexcept { return degrees * (std::numbers::pi / 180); }

ShearStrength strength_of(Real friction, Real cohesion) noexcept
{
  return {std::sin(in_radians(friction)), cohesion * std::cos(in_radians(friction))};
}
/// The mean stress of the apex [Pa].
Real apex(const ShearStrength& strength) noexcept { return strength.sine > 0 ? strength.cohesive / strength.sine : infinite; }

/// Twice the excess of the stress over the plane between s1 and s3 [Pa].
Real excess(Real s1, Real s3, const ShearStrength& strength) noexcept
{
  return s1 * (1 + strength.sine) - s3 * (1 - strength.sine) - 2 * strength.cohesive;
}

/// The end of a return: principal stresses in descending order [Pa].
struct StressReturn {
  Vec3 stress;
  Real dilation = 0;   ///< volume strain of the flow on the planes [-]; set only if the material opens
  bool opens = false;  ///< whether the remaining volume of the return is stored as opened
};

/// The return by backward Euler to the surface of one strength, from principal trial stresses in descending order.  Every active plane has
/// a multiplier; flow on the plane between s1 and s3 changes the strain by (1 + sin_psi, 0, -(1 - sin_psi)) times the multiplier, a crack
/// by (1, 0, 0).  With `bulk` = 0 the mean stress is constant.
struct Surface {
  Real bulk, shear;
  ShearStrength strength;
  Real sin_psi, cutoff;

  Real lambda() const noexcept { return bulk - 2 * shear / 3; }

  /// Stresses across the active planes; equal ones are represented by their mean.
  struct Pair {
    Real s1, s3, multiplier;  ///< multiplier: the sum over the planes
  };
  /// `share1`, `share3`: the fraction of the sum of multipliers that acts on each of the stresses in s1 and s3: 1 for a single stress, else
  /// 1/2.
  Pair along(Real s1, Real s3, Real share1, Real share3) const noexcept
  {
    const Real volumetric = 2 * lambda() * sin_psi;
    const Real fall1 = volumetric + 2 * shear * share1 * (1 + sin_psi), fall3 = volumetric - 2 * shear * share3 * (1 - sin_psi);
    const Real m = excess(s1, s3, strength) / (fall1 * (1 + strength.sine) - fall3 * (1 - strength.sine));
    return {s1 - m * fall1, s3 - m * fall3, m};
  }

  /// The return to the apex: the flow removes all shear, and the least volume that it can.  Of the combinations of flow vectors with a
  /// given deviator that of two neighbouring planes has the least volume, 2 sin_psi times the sum of multipliers.
  StressReturn to_apex(const Vec3& trial) const noexcept
  {
    if (!(strength.sine > 0))  // without cohesion there is no apex, but no shear either, up to round-off
      return {Vec3::Constant(trial.mean())};
    const Real a = (trial[0] - trial[1]) / (2 * shear * (1 + sin_psi)), b = (trial[1] - trial[2]) / (2 * shear * (1 - sin_psi));
    const Real multiplier = a > b ? b + 2 * (a - b) * (1 + sin_psi) / (3 + sin_psi) : a + 2 * (b - a) * (1 - sin_psi) / (3 - sin_psi);
    return {Vec3::Constant(apex(strength)), 2 * sin_psi * multiplier, true};
  }

  StressReturn to_planes(const Vec3& trial) const noexcept
  {
    const Pair plane = along(trial[0], trial[2], 1, 1);
    const Real s2 = trial[1] - 2 * lambda() * sin_psi * plane.multiplier;
    if (plane.s1 >= s2 && s2 >= plane.s3)
      return {{plane.s1, s2, plane.s3}, 2 * sin_psi * plane.multiplier};
    const bool upper = s2 > plane.s1;  // true if s1 = s2, as in triaxial compression; otherwise s2 = s3, as in extension
    const Pair edge = upper ? along(0.5 * (trial[0] + trial[1]), trial[2], 0.5, 1) : along(trial[0], 0.5 * (trial[1] + trial[2]), 1, 0.5);
    if (edge.s1 >= edge.s3)
      return {{edge.s1, upper ? edge.s1 : edge.s3, edge.s3}, 2 * sin_psi * edge.multiplier};
    return to_apex(trial);
  }

  /// The return by cracks across one, two or three directions, each with the stress change of uniaxial strain.
  StressReturn to_cutoff(const Vec3& trial) const noexcept
  {
    const Real across_one = lambda() / (lambda() + 2 * shear), across_two = lambda() / (2 * (lambda() + shear));
    Vec3 s = trial - across_one * (trial[0] - cutoff) * Vec3::Ones();
    s[0] = cutoff;
    if (s[1] <= cutoff)
      return {s};
    s[1] = cutoff;
    s[2] = trial[2] - across_two * (trial[0] + trial[1] - 2 * cutoff);
    if (s[2] <= cutoff)
      return {s};
    return {Vec3::Constant(cutoff), 0, true};
  }

  /// The return where crack and plane are both active: s1 and s3 are known, s2 follows the flow until it meets one of them.
  StressReturn to_both(const Vec3& trial) const noexcept
  {
    const Real s3 = (cutoff * (1 + strength.sine) - 2 * strength.cohesive) / (1 - strength.sine);
    const Real fall1 = trial[0] - cutoff, fall3 = trial[2] - s3, volumetric = 2 * lambda() * sin_psi;
    const Real plane1 = volumetric + 2 * shear * (1 + sin_psi), plane3 = volumetric - 2 * shear * (1 - sin_psi);
    const Real determinant = 4 * shear * (1 - sin_psi) * (lambda() + shear);
    const Real plane = (fall1 * lambda() - fall3 * (lambda() + 2 * shear)) / determinant;
    const Real crack = (fall3 * plane1 - fall1 * plane3) / determinant;
    const Real s2 = trial[1] - plane * volumetric - crack * lambda();
    return {{cutoff, std::clamp(s2, s3, cutoff), s3}, 2 * sin_psi * std::max(plane, Real{0})};
  }

  StressReturn operator()(const Vec3& trial) const noexcept
  {
    StressReturn end{trial};
    if (excess(trial[0], trial[2], strength) > 0)
      end = to_planes(trial);
    if (!(end.stress[0] > cutoff) || cutoff >= apex(strength))
      return end;
    end = to_cutoff(trial);
    return excess(end.stress[0], end.stress[2], strength) > 0 ? to_both(trial) : end;
  }
};

/// The return with a strength that decreases during the step.
struct SofteningReturn {
  const MohrCoulomb::Constants& c;
  const Vec3& trial;
  bool closing;  ///< opened volume closes, so the mean stress is at most zero

  StressReturn land(const ShearStrength& strength) const noexcept
  {
    const StressReturn end = Surface{c.bulk, c.shear, strength, c.sin_psi, c.cutoff}(trial);
    if (!closing || end.stress.sum() <= 0)
      return end;
    const Vec3 flat = trial.array() - trial.mean();
    StressReturn opened = Surface{0, c.shear, strength, c.sin_psi, c.cutoff}(flat);
    opened.opens = true;
    return opened;
  }

  /// The equivalent plastic strain sqrt(2/3 e:e).
  Real plastic_strain(const StressReturn& end) const noexcept
  {
    const Vec3 gone = trial - end.stress;
    return (gone.array() - gone.mean()).matrix().norm() / (std::numbers::sqrt2 * square_root_of_3 * c.shear);
  }

  /// The end of the return with the softened strength, and its plastic strain, which solves 0 = g(x) = start + plastic_strain - x.  Solved
  /// by secants from the return with the strength before the step, with a bisection in every fourth iteration.  g is nearly linear; where
  /// it has no root before the softening ends, the strength drops to residual at once.
  std::pair<StressReturn, Real> softened(const StressReturn& before, Real start) const noexcept
  {
    StressReturn end = land(c.residual);
    Real low = start, high = start + plastic_strain(end);
    if (high >= c.softening_strain)
      return {end, high};
    const auto g = [&](Real x) {
      end = land(c.strength_at(x));
      return start + plastic_strain(end) - x;
    };
    const Real tolerance = 1e-12 * (high - start) + 1e-16 * high;
    Real last = low, g_last = plastic_strain(before), x = high, g_x = g(x);
    if (g_x > 0) {  // the residual surface is not everywhere inside the peak surface
      x = high = c.softening_strain;
      g_x = g(x);
    }
    constexpr int enough = 200;
    for (int i = 1; i < enough && std::abs(g_x) > tolerance && high - low > tolerance; ++i) {
      const Real secant = x - g_x * (x - last) / (g_x - g_last);
      last = x, g_last = g_x;
      x = secant > low && secant < high && i % 4 != 0 ? secant : 0.5 * (low + high);
      g_x = g(x);
      (g_x > 0 ? low : high) = x;
    }
    return {end, x};
  }
};

/// The tensor with these principal values and axes.
Sym3 along_axes(const Mat3& axes, const Vec3& values) noexcept { return pack(axes * values.asDiagonal() * axes.transpose()); }

/// cos(3 angle) of Lode's angle: 1 if the two smaller principal values are equal, -1 if the two larger are, NaN without shear.
Real lode_cosine(const ElasticTrial<Real>& trial) noexcept
{
  const Sym3& e = trial.shear_strain;
  const Real J3 = e[0] * (e[1] * e[2] - e[4] * e[4]) - e[3] * (e[3] * e[2] - e[4] * e[5]) + e[5] * (e[3] * e[4] - e[1] * e[5]);
  const Real size = trial.shear;
  return std::clamp(4 * J3 / (size * size * size), Real{-1}, Real{1});
}

/// Whether the trial state is inside the surface by its invariants alone.  The planes are outside the cone tau sqrt(1 + sine^2/3) + sine
/// mean = cohesive, which they touch; beyond the cone the principal stresses from Lode's angle decide, which near the edges has half of the
/// digits.
bool surely_inside(const ElasticTrial<Real>& trial, Real mean, Real tau, const ShearStrength& strength, Real cutoff) noexcept
{
  if (tau * std::sqrt(1 + strength.sine * strength.sine / 3) + strength.sine * mean <= strength.cohesive &&
      mean + 2 / square_root_of_3 * tau <= cutoff)
    return true;
  constexpr Real blur = 1e-7;
  const Real angle = std::acos(lode_cosine(trial)) / 3, margin = blur * tau;
  const Real s1 = mean + 2 / square_root_of_3 * tau * std::cos(angle),
             s3 = mean - 2 / square_root_of_3 * tau * std::cos(std::numbers::pi / 3 - angle);
  return excess(s1, s3, strength) < -margin && s1 < cutoff - margin;
}

/// The principal axes of the shear strain.  The closed form is three times as fast, and accurate to 1e-13 unless two values are nearly
/// equal.
Eigen::SelfAdjointEigenSolver<Mat3> principal_axes(const ElasticTrial<Real>& trial) noexcept
{
  constexpr Real distinct = 0.99;
  Eigen::SelfAdjointEigenSolver<Mat3> axes;
  if (std::abs(lode_cosine(trial)) < distinct)
    axes.computeDirect(unpack(trial.shear_strain));
  else
    axes.compute(unpack(trial.shear_strain));
  return axes;
}

}  // namespace

MohrCoulomb::Constants MohrCoulomb::constants() const noexcept
{
  const ShearStrength peak = strength_of(friction_angle, cohesion);
  const ShearStrength residual = strength_of(softened_friction_angle(), softened_cohesion());
  const Real strain = softening_strain.value_or(infinite);
  const Moduli elastic = moduli();
  return {.bulk = elastic.bulk,
          .shear = elastic.shear,
          .peak = peak,
          .residual = residual,
          .slope = {(residual.sine - peak.sine) / strain, (residual.cohesive - peak.cohesive) / strain},
          .softening_strain = strain,
          .sin_psi = std::sin(in_radians(dilation_angle)),
          .cutoff = tension_cutoff.value_or(infinite)};
}

Mat3 MohrCoulomb::update(const Increment& in, State& state, const Constants& c) const noexcept
{
  const Real J = in.F.determinant();
  const ElasticTrial trial(in, state.elastic_left);
  if (!(J > 0 && trial.is_finite()))
    return no_answer();
  Real mean = c.bulk * trial.volume_strain;
  // Volume that was opened before closes first; the material has no tension meanwhile.
  const bool closing = !in.elastic && state.opened_volume > 0 && mean < 0;
  const ShearStrength strength = c.strength_at(state.plastic_strain);
  if (in.elastic || (!closing && surely_inside(trial, mean, c.shear * square_root_of_3 * trial.shear, strength, c.cutoff))) {
    state.elastic_left = trial.left;
    return unpack(scale_and_shift(2 * c.shear / J, trial.shear_strain, mean / J));
  }
  if (closing)
    mean += c.bulk * state.opened_volume;

  const Eigen::SelfAdjointEigenSolver<Mat3> axes = principal_axes(trial);
  const Vec3 start = mean + 2 * c.shear * axes.eigenvalues().reverse().array();
  const SofteningReturn map{c, start, closing};
  StressReturn end = map.land(strength);
  if (c.softening_strain < infinite && end.stress != start)
    std::tie(end, state.plastic_strain) = map.softened(end, state.plastic_strain);
  else
    state.plastic_strain += map.plastic_strain(end);

  const Real end_mean = end.stress.mean(), volume = (mean - end_mean) / c.bulk;
  const Vec3 shear = end.stress.array() - end_mean;
  const Vec3 plastic = ((start - end.stress).array() - (mean - end_mean)) / (2 * c.shear) + volume / 3;
  state.plastic_work += std::max(end.stress.dot(plastic), Real{0});  // associated flow without cohesion dissipates nothing, up to round-off
  state.opened_volume = (closing ? 0 : state.opened_volume) + (end.opens ? std::max(volume - end.dilation, Real{0}) : 0);
  const Mat3 directions = axes.eigenvectors().rowwise().reverse();
  if (closing || end.stress != start)
    state.elastic_left =
        along_axes(directions, shear.unaryExpr([&](Real s) { return std::expm1(s / c.shear + 2 * end_mean / (3 * c.bulk)); }));
  else
    state.elastic_left = trial.left;
  return unpack(along_axes(directions, end.stress / J));
}

Real MohrCoulomb::yield(const Mat3&, const State& state) const noexcept
{
  const Constants c = constants();
  const Mat3 strain = 0.5 * unpack(log1p(state.elastic_left));
  const Vec3 shear = Eigen::SelfAdjointEigenSolver<Mat3>(dev(strain), Eigen::EigenvaluesOnly).eigenvalues();
  const Real mean = c.bulk * strain.trace(), s1 = mean + 2 * c.shear * shear[2], s3 = mean + 2 * c.shear * shear[0];
  return std::max(0.5 * excess(s1, s3, c.strength_at(state.plastic_strain)), s1 - c.cutoff);
}

void MohrCoulomb::check(std::vector<std::string>& problems) const
{
  Elasticity::check(problems);
  SoilStrength::check(problems);
  if (tension_cutoff && *tension_cutoff > tip_of_strength())
    problems.push_back(fmt::format("tension_cutoff {} is above the apex, {:.6g} Pa", *tension_cutoff, tip_of_strength()));
}

void MohrCoulomb::divide_strength(Real factor) noexcept
{
  divide_shear_strength(factor);
  divide_cutoff(factor, tip_of_strength());
}

Real MohrCoulomb::tip_of_strength() const noexcept { return apex(strength_of(friction_angle, cohesion)); }

}  // namespace talus
