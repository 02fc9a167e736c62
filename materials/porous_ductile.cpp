#include "materials/porous_ductile.hpp"

#include <fmt/format.h>

#include <numbers>

#include "materials/parts/radial_return.hpp"
#include "materials/parts/scalar_root.hpp"

namespace talus {

namespace {

using PorousConstants = PorousDuctile::Constants;

/// Within a step the surface keeps at least this share of 1 - f* / (ultimate f*), so that there is one to return to.
constexpr Real least_left = 0.01;
/// cosh of more is not needed: it would not leave porosities that numbers can express.
constexpr Real largest_argument = 300;

/// What the trial state and the state before the step leave to be found.  Stresses are Cauchy's; pressure and tension are alike but for
/// the porosity.
template <class T>
struct PorousReturn {
  using N = Jet<T, 2>;  // by the volumetric plastic strain x of the step, its size, and by the plastic strain y of the matrix
  const PorousDuctile& law;
  const PorousConstants& c;
  T mean, shear;                    ///< sizes of mean stress and von Mises stress of the trial state [Pa]
  T bulk_stiffness, stiffness;      ///< their decrease per plastic strain [Pa]
  T porosity, matrix_strain;        ///< before the step
  MaskOf<T> tension;                ///< whether voids grow
  T closure;                        ///< volumetric plastic strain that closes all voids
  MaskOf<T> closing = T(0) > T(1);  ///< lanes in which all voids close within the step
  MaskOf<T> tearing = T(0) > T(1);  ///< lanes in which few voids become many within the step
  T torn = 0;                       ///< their x
  T x = 0;                          ///< what belongs to the y that was tried last

  struct At {
    N surface;   ///< yield function, decreasing with x: q from the flow rule, p from x
    N balance;   ///< work of the stress minus that of the matrix [Pa]
    N q;         ///< von Mises stress at the end [Pa]
    N porosity;  ///< at the end; that before the step under pressure
    N strength;  ///< of the matrix [Pa]
  };

  N effective(const N& f) const noexcept
  {
    const N joined = where(f.value > c.begin, c.begin + c.rising * (f - c.begin), f);
    return clamped(joined, -1, (1 - least_left) * c.ultimate);
  }
  N strength_at(const N& e) const noexcept
  {
    using std::pow;
    const T gain = law.hardening_coefficient > 0 ? T(law.hardening_coefficient * pow(e.value, law.hardening_exponent)) : T(0);
    return law.yield_stress + N::chain(gain, law.hardening_exponent * gain / above_nothing(e.value), e);
  }
  /// Porosity that has nucleated over y, by the middle of the strains.
  N nucleated(const N& y) const noexcept
  {
    if (c.nucleated == 0)
      return T(0);
    const N distance = (matrix_strain + 0.5 * y - c.mean_strain) * c.inverse;
    return c.nucleated * y * exp(-0.5 * distance * distance);
  }
  At at(const T& volume, const T& matrix) const noexcept
  {
    using std::expm1;
    const N v = where(closing, N(volume), N::unknown(volume, 0)), y = N::unknown(matrix, 1);
    const N strength = strength_at(matrix_strain + y);
    const T closed = expm1(T(-v.value));
    const N opened = N::chain(-closed, 1 + closed, v);  // 1 - exp(-v), with the digits of few voids
    const N f = where(tension, porosity + (1 - porosity) * opened + nucleated(y), N(porosity)), voids = effective(f);
    const N p = mean - bulk_stiffness * v, h = clamped(1.5 * law.q2 * p / strength, 0, largest_argument);
    const T small = expm1(h.value), sine = 0.5 * (small + small / (1 + small)), cosine = 1 + 0.5 * small * (small / (1 + small));
    const N sinh = N::chain(sine, cosine, h), cosh = N::chain(cosine, sine, h);
    // x / (shear strain of the step) = (df/dp) / (df/dq), with the shear strain (q_trial - q) / stiffness, solved for q / s.
    const N steep = 3 * law.q1 * law.q2 * voids * sinh, sum = 2 * stiffness * v + strength * steep;
    const auto dense = closing || !(sum.value > 0);
    const N ratio = where(dense, N(T(1)), shear * steep / where(dense, N(T(1)), sum));
    const N q = where(closing && strength.value > shear, N(shear), strength * ratio);
    N pressed = p;
    if (any_of(closing)) {  // voids do not wait for more pressure than what closes them
      using std::log, std::sqrt;
      const T start = where(closing, porosity, T(0.5)), most = (1 + c.q3 * start * start) / (2 * law.q1 * above_nothing(start));
      const T needed = log(most + sqrt(where(most > 1, most * most - 1, T(0)))) / (1.5 * law.q2);
      pressed = where(closing && p.value > needed * strength.value, needed * strength, p);
    }
    const N work = pressed * v + q * (shear - q) / stiffness;
    return {ratio * ratio - (1 + c.q3 * voids * voids - 2 * law.q1 * voids * cosh), work - (1 - clamped(f, 0, c.failure)) * strength * y, q,
            f, strength};
  }

  /// The balance for y, and its slope with x as it follows from y.
  ValueAndSlopeOf<T> operator()(const T& y, const MaskOf<T>& yields) noexcept
  {
    const At trial = at(where(closing, closure, T(0)), y);
    const auto porous = !closing && mean > 0 && effective(trial.porosity).value > 0;
    const auto outside = where(porous, trial.surface.value, shear - trial.strength.value) > 0 || tearing;
    x = where(closing, closure, T(0));
    At now = trial;
    if (const auto searched = yields && porous && outside; any_of(searched)) {
      const auto surface = [&](const T& v) -> ValueAndSlopeOf<T> {
        const At there = at(v, y);
        return {there.surface.value, there.surface.slope[0]};
      };
      // Newton's first step from x = 0 leads to the first root: in long steps there may be others, where few voids have torn the metal.
      const T found = positive_root<T>(surface, mean / bulk_stiffness, -trial.surface.value / trial.surface.slope[0], searched && !tearing);
      x = where(searched, where(tearing, torn, found), x);
      now = at(x, y);
    }
    const auto flowing = porous && outside;
    const T follows = where(flowing, now.surface.slope[1] / now.surface.slope[0], T(0));
    const T rest = where(flowing && !tearing, -now.surface.value / now.surface.slope[0], T(0));  // exponentials keep 1e-10 of x
    x += rest;
    const auto inside = !closing && !outside;
    const N idle = N(T(0)) - (1 - clamped(trial.porosity, 0, c.failure)) * trial.strength * N::unknown(y, 1);
    return {where(inside, idle.value, now.balance.value + now.balance.slope[0] * rest),
            where(inside, idle.slope[1], now.balance.slope[1] - now.balance.slope[0] * follows)};
  }

  /// The same where the balance jumps over zero, because x jumps from one root to another.  Along the surface y is a function of x, which
  /// ends at y = 0 with the x of the unhardened matrix: there the stress does more work than the matrix, and at x = 0 less.
  T torn_matrix_flow(const T& most, const T& guess, const MaskOf<T>& open) noexcept
  {
    (*this)(T(0), open);
    T y = guess;
    const auto along = [&](const T& v) -> ValueAndSlopeOf<T> {
      const auto surface = [&](const T& matrix) -> ValueAndSlopeOf<T> {
        const At there = at(v, matrix);
        return {there.surface.value, there.surface.slope[1]};
      };
      y = positive_root<T>(surface, most, y, open);
      const At there = at(v, y);
      const N &balance = there.balance, &on = there.surface;
      return {-balance.value, balance.slope[1] * on.slope[0] / on.slope[1] - balance.slope[0]};
    };
    const T high = x;
    torn = where(open, positive_root<T>(along, high, 0.5 * high, open), torn);
    along(torn);
    tearing = tearing || open;
    return y;
  }

  /// The plastic strain of the matrix, in the lanes of `yields`.
  T matrix_flow(const MaskOf<T>& yields) noexcept
  {
    const N before = strength_at(N(matrix_strain));
    // Most work that the stress can do while it falls, by the weakest matrix.
    const T most = (mean * mean / bulk_stiffness + shear * shear / stiffness) / (4 * (1 - c.failure) * before.value) +
                   where(closing, mean * closure / ((1 - c.failure) * before.value), T(0));
    const T first = (*this)(T(0), yields).value / ((1 - porosity) * before.value);
    const auto balance = [&](const T& y) { return (*this)(y, yields); };
    T y = positive_root<T>(balance, most, first, yields);
    using std::abs;
    if (const auto open = yields && tension && abs((*this)(y, yields).value) > 1e-6 * before.value * y; any_of(open))
      y = where(open, torn_matrix_flow(most, y, open), y);
    return y;
  }
};

}  // namespace

PorousDuctile::Constants PorousDuctile::constants() const noexcept
{
  const Moduli elastic = moduli();
  Constants c{.bulk = elastic.bulk,
              .shear = elastic.shear,
              .q3 = q3.value_or(q1 * q1),
              .ultimate = 0,
              .begin = 1,
              .failure = 0,
              .rising = 1,
              .nucleated = 0,
              .mean_strain = 0,
              .inverse = 1};
  c.ultimate = 1 / (q1 + std::sqrt(std::max(q1 * q1 - c.q3, Real{0})));
  c.failure = std::min(c.ultimate, Real{0.99});
  if (coalescence) {
    c.begin = coalescence->porosity;
    c.failure = coalescence->failure_porosity;
    c.rising = (c.ultimate - c.begin) / (c.failure - c.begin);
  }
  if (nucleation) {
    c.inverse = 1 / nucleation->deviation;
    c.mean_strain = nucleation->mean_strain;
    c.nucleated = nucleation->porosity * c.inverse / std::sqrt(2 * std::numbers::pi);
  }
  return c;
}

Real PorousDuctile::flow_stress(Real matrix_strain) const noexcept
{
  return yield_stress + hardening_coefficient * (matrix_strain > 0 ? std::pow(matrix_strain, hardening_exponent) : 0);
}

template <class T>
Mat3Of<T> PorousDuctile::update(const IncrementOf<T>& in, StateOf<T, State>& state, const Constants& c) const noexcept
{
  using std::abs, std::expm1, std::log1p, std::max, std::min;
  const T J = in.F.determinant();
  const ElasticTrial<T> trial(in, get(state, &State::elastic_left));
  if (!all_of(J > 0 && trial.is_finite()))
    return no_answer_somewhere(*this, in, state, c);
  const T stiffness = 3 * c.shear / J, bulk_stiffness = c.bulk / J;
  T q = stiffness * trial.shear, p = bulk_stiffness * trial.volume_strain, plastic_volume = 0;
  const T q_trial = q;
  T porosity = initial_porosity + get(state, &State::porosity_gain);
  const auto failed_before = porosity >= c.failure;
  if (!in.elastic) {
    PorousReturn<T> map{
        *this, c, abs(p), q, bulk_stiffness, stiffness, porosity, get(state, &State::matrix_strain), p > 0, T(-log1p(-porosity))};
    const auto start = map.at(T(0), T(0));
    const auto porous = map.mean > 0 && porosity > 0;
    const auto yields = !failed_before && where(porous, start.surface.value, q - start.strength.value) > 0;
    if (any_of(yields)) {
      T matrix = map.matrix_flow(yields);
      map(matrix, yields);
      if (const auto closed = yields && !map.tension && map.x > map.closure && porosity > 0; any_of(closed)) {
        map.closing = closed;
        matrix = where(closed, map.matrix_flow(closed), matrix);
        map(matrix, yields);
      }
      const auto end = map.at(map.x, matrix);
      const T volume = where(yields, map.x, 0);
      plastic_volume = where(map.tension, volume, -volume);
      const T left = map.mean - bulk_stiffness * volume;
      p = where(map.tension, left, -left);
      q = where(yields, min(max(end.q.value, T(0)), q_trial), q);
      const T sheared = (q_trial - q) / stiffness;
      const T grown =
          where(map.tension, end.porosity.value, max(T(where(map.closing, T(0), porosity - (1 - porosity) * expm1(volume))), T(0)));
      porosity = where(yields, min(grown, T(c.failure)), porosity);
      put(state, &State::plastic_strain, T(get(state, &State::plastic_strain) + where(yields, sheared, 0)));
      put(state, &State::matrix_strain, T(get(state, &State::matrix_strain) + where(yields, matrix, 0)));
      put(state, &State::plastic_work, T(get(state, &State::plastic_work) + where(yields, J * (p * plastic_volume + q * sheared), 0)));
      put(state, &State::porosity_gain, T(where(yields, porosity - initial_porosity, get(state, &State::porosity_gain))));
    }
  }
  // A failed particle bears neither shear nor tension; the elastic energy of both is lost with it.
  T bears = 1, pressed = p;
  if (const auto failed = porosity >= c.failure; any_of(failed)) {
    const T energy = J * (q * q / (2 * stiffness) + where(p > 0, p * p / (2 * bulk_stiffness), 0));
    put(state, &State::plastic_work, T(get(state, &State::plastic_work) + where(failed && !failed_before, energy, 0)));
    bears = where(failed, 0, 1);
    pressed = where(failed, min(p, T(0)), p);
  }
  const T remaining = where(q_trial > 0, q * bears / above_nothing(q_trial), bears);
  const auto changed = remaining < 1 || !(plastic_volume == T(0));
  Sym3Of<T> left = trial.left;
  if (any_of(changed))
    left = where<T>(changed,
                    talus::expm1(scale_and_shift(2 * remaining, trial.shear_strain, (trial.volume_strain - plastic_volume) * (2.0 / 3))),
                    left);
  put(state, &State::elastic_left, left);
  return unpack(scale_and_shift(2 * c.shear * remaining / J, trial.shear_strain, pressed));
}
template Mat3 PorousDuctile::update(const Increment&, State&, const Constants&) const noexcept;
template Mat3Of<SimdReal> PorousDuctile::update(const IncrementOf<SimdReal>&, StateLanes<State>&, const Constants&) const noexcept;

Real PorousDuctile::yield(const Mat3& stress, const State& state) const noexcept
{
  const Constants c = constants();
  const Real q = von_mises(stress), p = stress.trace() / 3, porosity = initial_porosity + state.porosity_gain;
  if (porosity >= c.failure)
    return q + std::max(p, Real{0});
  const PorousReturn<Real> map{*this, c, std::abs(p), q, 1, 1, porosity, state.matrix_strain, p > 0, 0};
  const Real s = flow_stress(state.matrix_strain), voids = map.effective(Jet<Real, 2>(porosity)).value;
  return s *
         (q * q / (s * s) + 2 * q1 * voids * std::cosh(std::min(1.5 * q2 * std::abs(p) / s, largest_argument)) - 1 - c.q3 * voids * voids);
}

void PorousDuctile::check(std::vector<std::string>& problems) const
{
  Elasticity::check(problems);
  const Constants c = constants();
  if (c.q3 > q1 * q1)
    problems.push_back(fmt::format("q3 {} is above the square of q1: the surface would not shrink to a point", c.q3));
  if (coalescence && !(c.failure > c.begin))
    problems.push_back(fmt::format("failure_porosity {} is not above the porosity {} at which voids join", c.failure, c.begin));
  if (coalescence && !(c.begin < c.ultimate))
    problems.push_back(fmt::format("voids join at porosity {}, where by q1 nothing is left: that is {:.6g}", c.begin, c.ultimate));
  if (!(initial_porosity < c.failure))
    problems.push_back(fmt::format("initial_porosity {} is not below that of failure, {:.6g}", initial_porosity, c.failure));
}

}  // namespace talus
