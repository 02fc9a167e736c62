#include "materials/mohr_coulomb.hpp"

#include <fmt/format.h>

#include <numbers>

#include "materials/parts/principal_axes.hpp"
#include "materials/parts/radial_return.hpp"

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
template <class T>
T apex(const ShearStrengthOf<T>& strength) noexcept
{
  const auto has_friction = strength.sine > 0;
  return where(has_friction, strength.cohesive / where(has_friction, strength.sine, 1), infinite);
}

/// Twice the excess of the stress over the plane between s1 and s3 [Pa].
template <class T>
T excess(const T& s1, const T& s3, const ShearStrengthOf<T>& strength) noexcept
{
  return s1 * (1 + strength.sine) - s3 * (1 - strength.sine) - 2 * strength.cohesive;
}

template <class T>
Vec3Of<T> three_times(const T& a) noexcept
{
  return {a, a, a};
}
template <class T>
T mean_of(const Vec3Of<T>& a) noexcept
{
  return (a[0] + a[1] + a[2]) / 3;
}
template <class T>
MaskOf<T> equal(const Vec3Of<T>& a, const Vec3Of<T>& b) noexcept
{
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/// The end of a return: principal stresses in descending order [Pa].
template <class T>
struct StressReturn {
  Vec3Of<T> stress;
  T dilation = 0;     ///< volume strain of the flow on the planes [-]; of use only if the material opens
  MaskOf<T> opens{};  ///< whether the remaining volume of the return is stored as opened
  friend StressReturn where(const MaskOf<T>& condition, const StressReturn& a, const StressReturn& b) noexcept
  {
    return {talus::where<T>(condition, a.stress, b.stress), where(condition, a.dilation, b.dilation),
            (condition && a.opens) || (!condition && b.opens)};
  }
};

/// The return by backward Euler to the surface of one strength, from principal trial stresses in descending order.  Every active plane has
/// a multiplier; flow on the plane between s1 and s3 changes the strain by (1 + sin_psi, 0, -(1 - sin_psi)) times the multiplier, a crack
/// by (1, 0, 0).  With `bulk` = 0 the mean stress is constant.
template <class T>
struct Surface {
  Real bulk, shear;
  ShearStrengthOf<T> strength;
  Real sin_psi, cutoff;

  Real lambda() const noexcept { return bulk - 2 * shear / 3; }

  /// Stresses across the active planes; equal ones are represented by their mean.
  struct Pair {
    T s1, s3, multiplier;  ///< multiplier: the sum over the planes
  };
  /// `share1`, `share3`: the fraction of the sum of multipliers that acts on each of the stresses in s1 and s3: 1 for a single stress, else
  /// 1/2.
  Pair along(const T& s1, const T& s3, const T& share1, const T& share3) const noexcept
  {
    const Real volumetric = 2 * lambda() * sin_psi;
    const T fall1 = volumetric + 2 * shear * share1 * (1 + sin_psi), fall3 = volumetric - 2 * shear * share3 * (1 - sin_psi);
    const T m = excess(s1, s3, strength) / (fall1 * (1 + strength.sine) - fall3 * (1 - strength.sine));
    return {s1 - m * fall1, s3 - m * fall3, m};
  }

  /// The return to the apex: the flow removes all shear, and the least volume that it can.  Of the combinations of flow vectors with a
  /// given deviator that of two neighbouring planes has the least volume, 2 sin_psi times the sum of multipliers.
  StressReturn<T> to_apex(const Vec3Of<T>& trial) const noexcept
  {
    const T a = (trial[0] - trial[1]) / (2 * shear * (1 + sin_psi)), b = (trial[1] - trial[2]) / (2 * shear * (1 - sin_psi));
    const T multiplier = where(a > b, b + 2 * (a - b) * (1 + sin_psi) / (3 + sin_psi), a + 2 * (b - a) * (1 - sin_psi) / (3 - sin_psi));
    // Without cohesion there is no apex, but no shear either, up to round-off.
    const auto has_apex = strength.sine > 0;
    return {three_times(where(has_apex, apex(strength), mean_of<T>(trial))), 2 * sin_psi * multiplier, has_apex};
  }

  /// The return to a plane, an edge or the apex in the lanes of `yields`; the others have no meaning.
  StressReturn<T> to_planes(const Vec3Of<T>& trial, const MaskOf<T>& yields) const noexcept
  {
    const Pair plane = along(trial[0], trial[2], 1, 1);
    const T s2 = trial[1] - 2 * lambda() * sin_psi * plane.multiplier;
    StressReturn<T> end{{plane.s1, s2, plane.s3}, 2 * sin_psi * plane.multiplier};
    const auto beside = yields && !(plane.s1 >= s2 && s2 >= plane.s3);
    if (!any_of(beside))
      return end;
    const auto upper = s2 > plane.s1;  // true if s1 = s2, as in triaxial compression; otherwise s2 = s3, as in extension
    const Pair edge = along(where(upper, 0.5 * (trial[0] + trial[1]), trial[0]), where(upper, trial[2], 0.5 * (trial[1] + trial[2])),
                            where(upper, T(0.5), T(1)), where(upper, T(1), T(0.5)));
    end = where(beside, {{edge.s1, where(upper, edge.s1, edge.s3), edge.s3}, 2 * sin_psi * edge.multiplier}, end);
    const auto beyond = beside && !(edge.s1 >= edge.s3);
    return any_of(beyond) ? where(beyond, to_apex(trial), end) : end;
  }

  /// The return by cracks across one, two or three directions, each with the stress change of uniaxial strain.
  StressReturn<T> to_cutoff(const Vec3Of<T>& trial) const noexcept
  {
    const Real across_one = lambda() / (lambda() + 2 * shear), across_two = lambda() / (2 * (lambda() + shear));
    const T fall = across_one * (trial[0] - cutoff), last = trial[2] - across_two * (trial[0] + trial[1] - 2 * cutoff);
    const StressReturn<T> one{{cutoff, trial[1] - fall, trial[2] - fall}}, two{{cutoff, cutoff, last}};
    const StressReturn<T> three{three_times(T(cutoff)), 0, T(1) > T(0)};
    return where(one.stress[1] <= cutoff, one, where(last <= cutoff, two, three));
  }

  /// The return where crack and plane are both active: s1 and s3 are known, s2 follows the flow until it meets one of them.
  StressReturn<T> to_both(const Vec3Of<T>& trial) const noexcept
  {
    using std::max, std::min;
    const T s3 = (cutoff * (1 + strength.sine) - 2 * strength.cohesive) / (1 - strength.sine);
    const T fall1 = trial[0] - cutoff, fall3 = trial[2] - s3;
    const Real volumetric = 2 * lambda() * sin_psi;
    const Real plane1 = volumetric + 2 * shear * (1 + sin_psi), plane3 = volumetric - 2 * shear * (1 - sin_psi);
    const Real determinant = 4 * shear * (1 - sin_psi) * (lambda() + shear);
    const T plane = (fall1 * lambda() - fall3 * (lambda() + 2 * shear)) / determinant;
    const T crack = (fall3 * plane1 - fall1 * plane3) / determinant;
    const T s2 = trial[1] - plane * volumetric - crack * lambda();
    return {{cutoff, max(s3, min(s2, T(cutoff))), s3}, 2 * sin_psi * max(plane, T(0))};
  }

  StressReturn<T> operator()(const Vec3Of<T>& trial) const noexcept
  {
    StressReturn<T> end{trial};
    if (const auto yields = excess(trial[0], trial[2], strength) > 0; any_of(yields))
      end = where(yields, to_planes(trial, yields), end);
    if (const auto tears = end.stress[0] > cutoff && cutoff < apex(strength); any_of(tears)) {
      StressReturn<T> torn = to_cutoff(trial);
      if (const auto both = tears && excess(torn.stress[0], torn.stress[2], strength) > 0; any_of(both))
        torn = where(both, to_both(trial), torn);
      end = where(tears, torn, end);
    }
    return end;
  }
};

/// The return with a strength that decreases during the step.
template <class T>
struct SofteningReturn {
  const MohrCoulomb::Constants& c;
  const Vec3Of<T>& trial;
  const MaskOf<T>& closing;  ///< opened volume closes, so the mean stress is at most zero

  StressReturn<T> land(const ShearStrengthOf<T>& strength) const noexcept
  {
    const StressReturn<T> end = Surface<T>{c.bulk, c.shear, strength, c.sin_psi, c.cutoff}(trial);
    const auto stays_open = closing && end.stress[0] + end.stress[1] + end.stress[2] > 0;
    if (!any_of(stays_open))
      return end;
    const Vec3Of<T> flat = trial - three_times(mean_of<T>(trial));
    StressReturn<T> opened = Surface<T>{0, c.shear, strength, c.sin_psi, c.cutoff}(flat);
    opened.opens = T(1) > T(0);
    return where(stays_open, opened, end);
  }

  /// The equivalent plastic strain sqrt(2/3 e:e).
  T plastic_strain(const StressReturn<T>& end) const noexcept
  {
    using std::sqrt;
    const Vec3Of<T> gone = trial - end.stress, flow = gone - three_times(mean_of<T>(gone));
    return sqrt(T(flow.squaredNorm())) / (std::numbers::sqrt2 * square_root_of_3 * c.shear);
  }

  /// The end of the return with the softened strength, and its plastic strain, which solves 0 = g(x) = start + plastic_strain - x, in the
  /// lanes of `flows`.  Solved by secants from the return with the strength before the step, with a bisection in every fourth iteration.
  /// g is nearly linear; where it has no root before the softening ends, the strength drops to residual at once.
  std::pair<StressReturn<T>, T> softened(const StressReturn<T>& before, const T& start, const MaskOf<T>& flows) const noexcept
  {
    using std::abs;
    StressReturn<T> end = land({c.residual.sine, c.residual.cohesive});
    T low = start, high = start + plastic_strain(end);
    auto open = flows && high < c.softening_strain;
    if (!any_of(open))
      return {end, high};
    const auto g = [&](const T& x) -> T {  // lanes that have converged are evaluated again at the same x, so that `end` is theirs
      end = land(c.strength_at(x));
      return start + plastic_strain(end) - x;
    };
    const T tolerance = 1e-12 * (high - start) + 1e-16 * high;
    T last = low, g_last = plastic_strain(before), x = high, g_x = g(x);
    if (const auto outside = open && g_x > 0; any_of(outside)) {  // the residual surface is not everywhere inside the peak surface
      x = high = where(outside, c.softening_strain, high);
      g_x = g(x);
    }
    constexpr int enough = 200;
    for (int i = 1; i < enough; ++i) {
      open = open && abs(g_x) > tolerance && high - low > tolerance;
      if (!any_of(open))
        break;
      const T fall = g_x - g_last, secant = x - g_x * (x - last) / where(fall == 0, T(1e-200), fall), middle = 0.5 * (low + high);
      const T next = i % 4 == 0 ? middle : where(secant > low && secant < high, secant, middle);
      last = x, g_last = g_x;
      x = where(open, next, x);
      g_x = g(x);
      const auto below = g_x > 0;
      low = where(open && below, x, low);
      high = where(open && !below, x, high);
    }
    return {end, x};
  }
};

/// The lanes whose trial state is inside the surface by its invariants alone.  The planes are outside the cone tau sqrt(1 + sine^2/3) +
/// sine mean = cohesive, which they touch; beyond the cone the principal stresses without axes decide, which near the edges have half of
/// the digits.
template <class T>
MaskOf<T> surely_inside(const ShearDirection<T>& direction, const T& mean, const T& tau, Real shear, const ShearStrengthOf<T>& strength,
                        Real cutoff) noexcept
{
  using std::sqrt;
  const auto in_cone = tau * sqrt(T(1 + strength.sine * strength.sine / 3)) + strength.sine * mean <= strength.cohesive &&
                       mean + 2 / square_root_of_3 * tau <= cutoff;
  if (all_of(in_cone))
    return in_cone;
  constexpr Real blur = 1e-7;
  const auto [most, least] = direction.rough_extremes();
  const T margin = blur * tau, s1 = mean + 2 * shear * most, s3 = mean + 2 * shear * least;
  return in_cone || (excess(s1, s3, strength) < -margin && s1 < cutoff - margin);
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

template <class T>
Mat3Of<T> MohrCoulomb::update(const IncrementOf<T>& in, StateOf<T, State>& state, const Constants& c) const noexcept
{
  using std::expm1, std::max;
  const T J = in.F.determinant();
  const ElasticTrial<T> trial(in, get(state, &State::elastic_left));
  if (!all_of(J > 0 && trial.is_finite()))
    return no_answer_somewhere(*this, in, state, c);
  const T per_volume = 1 / J;
  T mean = c.bulk * trial.volume_strain;
  const Sym3Of<T> elastic_stress = scale_and_shift(2 * c.shear * per_volume, trial.shear_strain, mean * per_volume);
  const auto elastic = [&] {
    put(state, &State::elastic_left, trial.left);
    return unpack(elastic_stress);
  };
  if (in.elastic)
    return elastic();
  // Volume that was opened before closes first; the material has no tension meanwhile.
  const T opened = get(state, &State::opened_volume), plastic_strain = get(state, &State::plastic_strain);
  const auto closing = opened > 0 && mean < 0;
  const ShearStrengthOf<T> strength = c.strength_at(in.softened_at != nullptr ? *in.softened_at : plastic_strain);
  const T size = 0.5 * square_root_of_3 * trial.shear;
  const ShearDirection<T> direction(trial.shear_strain, size);
  const auto inside = !closing && surely_inside<T>(direction, mean, 2 * c.shear * size, c.shear, strength, c.cutoff);
  if (all_of(inside))
    return elastic();
  mean = where(closing, mean + c.bulk * opened, mean);

  const PrincipalAxes<T> axes = direction.axes();
  const Vec3Of<T> start = three_times(mean) + T(2 * c.shear) * axes.values;
  const SofteningReturn<T> map{c, start, closing};
  StressReturn<T> end = map.land(strength);
  const auto flows = !inside && !equal<T>(end.stress, start), changed = closing || flows;
  if (!any_of(changed))
    return elastic();
  T strain = plastic_strain + map.plastic_strain(end);
  if (c.softening_strain < infinite && in.softened_at == nullptr && any_of(flows)) {
    const auto [softened, softened_strain] = map.softened(end, plastic_strain, flows);
    end = where(flows, softened, end);
    strain = where(flows, softened_strain, strain);
  }

  const T end_mean = mean_of<T>(end.stress), volume = (mean - end_mean) / c.bulk;
  const Vec3Of<T> shear = end.stress - three_times(end_mean);
  const Vec3Of<T> plastic = (start - end.stress - three_times(T(mean - end_mean))) * T(1 / (2 * c.shear)) + three_times(T(volume / 3));
  // Associated flow without cohesion dissipates nothing, up to round-off.
  const T work = max(T(end.stress.dot(plastic)), T(0));
  const T newly_opened = where(end.opens, max(T(volume - end.dilation), T(0)), 0);
  put(state, &State::plastic_strain, where(changed, strain, plastic_strain));
  put(state, &State::plastic_work, T(get(state, &State::plastic_work) + where(changed, work, 0)));
  put(state, &State::opened_volume, where(changed, where(closing, 0, opened) + newly_opened, opened));
  const auto left_along = [&](const T& s) -> T { return expm1(T(s / c.shear + 2 * end_mean / (3 * c.bulk))); };
  const Sym3Of<T> left = axes.tensor({left_along(shear[0]), left_along(shear[1]), left_along(shear[2])});
  put(state, &State::elastic_left, where<T>(changed, left, trial.left));
  return unpack(where<T>(changed, axes.tensor(end.stress * per_volume), elastic_stress));
}
template Mat3 MohrCoulomb::update(const Increment&, State&, const Constants&) const noexcept;
template Mat3Of<SimdReal> MohrCoulomb::update(const IncrementOf<SimdReal>&, StateLanes<State>&, const Constants&) const noexcept;

Real MohrCoulomb::yield(const Mat3&, const State& state, Real softened_at) const noexcept
{
  const Constants c = constants();
  const Mat3 strain = 0.5 * unpack(log1p(state.elastic_left));
  const Vec3 shear = Eigen::SelfAdjointEigenSolver<Mat3>(dev(strain), Eigen::EigenvaluesOnly).eigenvalues();
  const Real mean = c.bulk * strain.trace(), s1 = mean + 2 * c.shear * shear[2], s3 = mean + 2 * c.shear * shear[0];
  return std::max(0.5 * excess(s1, s3, c.strength_at(softened_at)), s1 - c.cutoff);
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
