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

Mat3 MuI::update(const Increment& in, State& state, const Constants& c) const noexcept
{
  const Real J = in.F.determinant();
  const Sym3 b = push_forward(in.dt * in.L, state.elastic_left);
  const Sym3 twice_strain = log1p(b);
  const Real volume_strain = 0.5 * trace(twice_strain);
  const Sym3 shear_strain = scale_and_shift(0.5, twice_strain, -volume_strain / 3);
  const Real tau = c.shear * std::sqrt(2 * squared_norm(shear_strain));
  if (!(J > 0 && std::isfinite(volume_strain + tau)))
    return no_answer();
  if (in.elastic) {
    state.elastic_left = b;
    return unpack(scale_and_shift(2 * c.shear / J, shear_strain, c.bulk * volume_strain / J));
  }

  // What opened before fills first; what is above zero after that stays open.
  const bool closing = state.opened_volume > 0;
  const Real strain = volume_strain + state.opened_volume;
  const Real p = std::max(-c.bulk * strain, Real{0});
  state.opened_volume = std::max(strain, Real{0});

  // Plastic shear m of the step: (tau - mu_s p - G m) (m + a) = (mu_2 - mu_s) p m, a the shear of the step at which I = I_0.
  Real m = 0;
  if (const Real excess = tau - static_friction * p; excess > 0) {
    const Real a = in.dt * c.rate_scale * std::sqrt(p / J);
    const Real linear = c.shear * a + (limiting_friction - static_friction) * p - excess;
    const Real root = std::sqrt(linear * linear + 4 * c.shear * excess * a);
    m = linear > 0 ? 2 * excess * a / (linear + root) : (root - linear) / (2 * c.shear);
  }
  const Real kept = m > 0 ? std::max(1 - c.shear * m / tau, Real{0}) : 1;
  if (m > 0 || closing || p == 0)
    state.elastic_left = expm1(scale_and_shift(2 * kept, shear_strain, -2 * p / (3 * c.bulk)));
  else
    state.elastic_left = b;
  state.plastic_strain += m / std::numbers::sqrt3;
  state.plastic_work += kept * tau * m;
  return unpack(scale_and_shift(2 * c.shear * kept / J, shear_strain, -p / J));
}

void MuI::prestress(const Mat3& stress, State& state) const noexcept
{
  const Constants c = constants();
  state.elastic_left = expm1(add_diagonal(pack(dev(stress) / c.shear), 2 * stress.trace() / (9 * c.bulk)));
}

Real MuI::yield(const Mat3&, const State& state) const noexcept
{
  const Constants c = constants();
  const Sym3 strain = 0.5 * log1p(state.elastic_left);
  const Real tau = c.shear * std::sqrt(2 * squared_norm(add_diagonal(strain, -trace(strain) / 3)));
  return tau + limiting_friction * c.bulk * trace(strain);
}

Real MuI::wave_speed(const Mat3& F, const Constants& c) const noexcept
{
  return std::sqrt((c.bulk + 4 * c.shear / 3) * (1 + std::max(-std::log(F.determinant()), Real{0})) / density);
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
