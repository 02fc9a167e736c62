#include "materials/mu_i.hpp"

#include <fmt/format.h>

#include <numbers>

namespace talus {

MuI::Constants MuI::constants() const noexcept
{
  const Moduli elastic = moduli();
  return {.bulk = elastic.bulk, .shear = elastic.shear, .rate_scale = inertial_number / (grain_diameter * std::sqrt(grain_density))};
}

Real MuI::friction(Real inertial) const noexcept
{
  return static_friction + (limiting_friction - static_friction) * inertial / (inertial_number + inertial);
}

template <class T>
Mat3Of<T> MuI::update(const IncrementOf<T>& in, StateOf<T, State>& state, const Constants& c) const noexcept
{
  using std::isfinite, std::max, std::sqrt;
  const T J = in.F.determinant();
  const Sym3Of<T> b = push_forward(in.dt * in.L, get(state, &State::elastic_left));
  const Sym3Of<T> twice_strain = log1p(b);
  const T volume_strain = 0.5 * trace(twice_strain);
  const Sym3Of<T> shear_strain = scale_and_shift(0.5, twice_strain, -volume_strain / 3);
  const T tau = c.shear * sqrt(T(2 * squared_norm(shear_strain)));
  if (!all_of(J > 0 && isfinite(T(volume_strain + tau))))
    return no_answer_somewhere(*this, in, state, c);
  if (in.elastic) {
    put(state, &State::elastic_left, b);
    return unpack(scale_and_shift(2 * c.shear / J, shear_strain, c.bulk * volume_strain / J));
  }

  // Volume that was opened before closes first; the remaining expansion stays open.
  const T opened = get(state, &State::opened_volume);
  const auto closing = opened > 0;
  const T strain = volume_strain + opened;
  const T p = max(T(-c.bulk * strain), T(0));
  put(state, &State::opened_volume, max(strain, T(0)));

  // The plastic shear m of the step solves (tau - mu_s p - G m) (m + a) = (mu_2 - mu_s) p m, where a is the shear of the step at which I =
  // I_0.
  T m = 0;
  const T excess = tau - static_friction * p;
  if (const auto flows = excess > 0; any_of(flows)) {
    const T a = in.dt * c.rate_scale * sqrt(T(p / J));
    const T linear = c.shear * a + (limiting_friction - static_friction) * p - excess;
    const T root = sqrt(T(linear * linear + 4 * c.shear * excess * a));
    const auto far = linear > 0;
    m = where(flows, where(far, 2 * excess * a / where(far, linear + root, 1), (root - linear) / (2 * c.shear)), 0);
  }
  const auto slid = m > 0;
  const T remaining = where(slid, max(T(1 - c.shear * m / where(slid, tau, 1)), T(0)), 1);
  Sym3Of<T> left = b;
  if (const auto changed = m > 0 || closing || p == 0; any_of(changed))
    left = where(changed, expm1(scale_and_shift(2 * remaining, shear_strain, p * (-2 / (3 * c.bulk)))), b);
  put(state, &State::elastic_left, left);
  put(state, &State::plastic_strain, T(get(state, &State::plastic_strain) + m * std::numbers::inv_sqrt3));
  put(state, &State::plastic_work, T(get(state, &State::plastic_work) + remaining * tau * m));
  return unpack(scale_and_shift(2 * c.shear * remaining / J, shear_strain, -p / J));
}
template Mat3 MuI::update(const Increment&, State&, const Constants&) const noexcept;
template Mat3Of<SimdReal> MuI::update(const IncrementOf<SimdReal>&, StateLanes<State>&, const Constants&) const noexcept;

Real MuI::yield(const Mat3&, const State& state) const noexcept
{
  const Moduli elastic = moduli();
  return cone_yield(state, elastic.bulk, elastic.shear, limiting_friction, 0);
}

void MuI::check(std::vector<std::string>& problems) const
{
  Elasticity::check(problems);
  if (limiting_friction < static_friction)
    problems.push_back(fmt::format("limiting_friction {} is below static_friction {}", limiting_friction, static_friction));
  if (density > grain_density)
    problems.push_back(fmt::format("density {} of grains and voids is above grain_density {}", density, grain_density));
}

}  // namespace talus
