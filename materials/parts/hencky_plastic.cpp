#include "materials/parts/hencky_plastic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "materials/parts/logarithm.hpp"
#include "materials/parts/radial_return.hpp"

namespace talus {

Sym3 HenckyPlastic::elastic_left_under(const Mat3& stress) const noexcept
{
  const Moduli elastic = moduli();
  return elastic_left_of(dev(stress), elastic.shear, stress.trace() / (3 * elastic.bulk));
}

template <class T>
T HenckyPlastic::wave_speed_of(const Mat3Of<T>& F, Real bulk, Real shear) const noexcept
{
  using std::max, std::sqrt;
  const T J = F.determinant(), compression = 0.5 * (1 / J - J);  // for J <= 1 above -ln J, by (1 - J)^3 / 6
  return sqrt(T((bulk + 4 * shear / 3) * (1 + max(compression, T(0))) / density));
}
template Real HenckyPlastic::wave_speed_of(const Mat3&, Real, Real) const noexcept;
template SimdReal HenckyPlastic::wave_speed_of(const Mat3Of<SimdReal>&, Real, Real) const noexcept;

void ConePlastic::prestress(const Mat3& stress, State& state) const noexcept
{
  const Moduli elastic = moduli();
  state.elastic_left = expm1(add_diagonal(pack(dev(stress) / elastic.shear), 2 * stress.trace() / (9 * elastic.bulk)));
}

Real ConePlastic::cone_yield(const State& state, Real bulk, Real shear, Real q, Real k) const noexcept
{
  const Sym3 strain = 0.5 * log1p(state.elastic_left);
  const Real tau = shear * std::sqrt(2 * squared_norm(add_diagonal(strain, -trace(strain) / 3)));
  return tau + q * bulk * trace(strain) - k;
}

void SoilStrength::check(std::vector<std::string>& problems) const
{
  const Real residual_friction = softened_friction_angle();
  if (dilation_angle > friction_angle)
    problems.push_back(fmt::format("dilation_angle {} is above friction_angle {}", dilation_angle, friction_angle));
  else if (dilation_angle > residual_friction)
    problems.push_back(fmt::format("dilation_angle {} is above residual_friction_angle {}", dilation_angle, residual_friction));
  if (residual_friction > friction_angle)
    problems.push_back(fmt::format("residual_friction_angle {} is above friction_angle {}", residual_friction, friction_angle));
  if (softened_cohesion() > cohesion)
    problems.push_back(fmt::format("residual_cohesion {} is above cohesion {}", *residual_cohesion, cohesion));
  if ((residual_friction_angle || residual_cohesion) && !softening_strain)
    problems.emplace_back("residual_friction_angle and residual_cohesion need softening_strain");
  if (softening_strain && !residual_friction_angle && !residual_cohesion)
    problems.emplace_back("softening_strain needs residual_friction_angle or residual_cohesion");
  if (softening_length && !softening_strain)
    problems.emplace_back("softening_length needs softening_strain");
}

void SoilStrength::divide_shear_strength(Real factor) noexcept
{
  const auto angle_over = [factor](Real degrees) {  // the angle whose tangent is that of `degrees` divided by the factor
    constexpr Real degree = std::numbers::pi / 180;
    return factor == 1 ? degrees : std::atan(std::tan(degrees * degree) / factor) / degree;
  };
  cohesion /= factor;
  friction_angle = angle_over(friction_angle);
  if (residual_cohesion)
    *residual_cohesion /= factor;
  if (residual_friction_angle)
    residual_friction_angle = angle_over(*residual_friction_angle);
  dilation_angle = std::min({dilation_angle, friction_angle, softened_friction_angle()});
}

void SoilStrength::divide_cutoff(Real factor, Real tip) noexcept
{
  if (tension_cutoff)
    tension_cutoff = std::min(*tension_cutoff / factor, tip);
}

}  // namespace talus
