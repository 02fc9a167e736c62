#include "mesh/conditions/soil_column.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talus {

namespace {

template <int D>
auto level_row(std::vector<Real>& numbers, std::size_t i)
{
  return Eigen::Map<Vec<D>>(&numbers[D * i]);
}
template <int D>
auto level_row(const std::vector<Real>& numbers, std::size_t i)
{
  return Eigen::Map<const Vec<D>>(&numbers[D * i]);
}

/// The shear modulus [Pa].
Real shear_modulus(const Halfspace& ground) { return ground.density * ground.s_wave * ground.s_wave; }
Real confined_modulus(const Halfspace& ground) { return ground.density * ground.p_wave * ground.p_wave; }

}  // namespace

template <int D>
std::size_t SoilColumn<D>::layer_at(Real height) const noexcept
{
  const auto above = static_cast<std::size_t>(std::upper_bound(level.begin(), level.end(), height) - level.begin());
  return std::clamp(above, std::size_t{1}, layer.size()) - 1;
}

template <int D>
Vec<D> SoilColumn<D>::velocity_at(Real height, const ColumnMotion& motion) const noexcept
{
  const std::size_t l = layer_at(height);
  const Real share = std::clamp((height - level[l]) / (level[l + 1] - level[l]), Real{0}, Real{1});
  return (1 - share) * level_row<D>(motion.velocity, l) + share * level_row<D>(motion.velocity, l + 1);
}

/// The stress of a displacement u(h) along the axis a of the column is lambda (a.u') I + mu (a u' + u' a).  On a plane with normal n across a
/// its traction is (lambda a.u') n + (mu n.u') a, and the traction on horizontal planes gives both terms.
template <int D>
Vec<D> SoilColumn<D>::force_on(const Vec<D>& area, std::size_t at_layer, const ColumnMotion& motion) const noexcept
{
  const Layer& here = layer[at_layer];
  const Vec<D> t = level_row<D>(motion.traction, at_layer);
  const Real lambda_share = 1 - 2 * shear_modulus(here.ground) / confined_modulus(here.ground);
  return here.filled * (lambda_share * t.dot(up) * area + t.dot(area) * up);
}

template <int D>
void advance(const SoilColumn<D>& column, const ColumnBase<D>& base, Real dt, ColumnMotion& motion)
{
  const std::size_t n = column.layer.size();
  constexpr Real safe = 0.5;  // fraction of the time in which a wave crosses a layer, for stability
  Real longest = std::numeric_limits<Real>::infinity();
  const auto thickness = [&](std::size_t l) { return column.level[l + 1] - column.level[l]; };
  for (std::size_t l = 0; l < n; ++l)
    longest = std::min(longest, safe * thickness(l) / column.layer[l].ground.p_wave);
  const auto n_substeps = std::max(1, static_cast<int>(std::ceil(dt / longest)));
  const Real step = dt / n_substeps;
  const auto mass = [&](std::size_t l) { return column.layer[l].filled * column.layer[l].ground.density * thickness(l) / 2; };
  for (int substep = 0; substep < n_substeps; ++substep) {
    for (std::size_t i = 0; i <= n; ++i) {
      Real m = 0;  // mass of this level per area [kg/m^2]
      Vec<D> force = Vec<D>::Zero();
      if (i > 0)
        m += mass(i - 1), force -= column.layer[i - 1].filled * level_row<D>(motion.traction, i - 1);
      if (i < n)
        m += mass(i), force += column.layer[i].filled * level_row<D>(motion.traction, i);
      auto v = level_row<D>(motion.velocity, i);
      if (i > 0) {
        v += step / m * force;
      } else if (base.halfspace) {  // as for the compliant base of the model: see Dashpots::apply
        const Mat<D> resistance = impedance<D>(*base.halfspace, column.up);
        v = (m * Mat<D>::Identity() + step * resistance).inverse() * (m * v + step * (force + resistance * base.velocity * 2)).eval();
      } else {
        v = base.velocity;
      }
    }
    for (std::size_t l = 0; l < n; ++l) {
      const Halfspace& ground = column.layer[l].ground;
      const Vec<D> strain = (level_row<D>(motion.velocity, l + 1) - level_row<D>(motion.velocity, l)) * (step / thickness(l));
      level_row<D>(motion.traction, l) +=
          shear_modulus(ground) * strain + (confined_modulus(ground) - shear_modulus(ground)) * strain.dot(column.up) * column.up;
    }
  }
}

template struct SoilColumn<2>;
template struct SoilColumn<3>;
template void advance<2>(const SoilColumn<2>&, const ColumnBase<2>&, Real, ColumnMotion&);
template void advance<3>(const SoilColumn<3>&, const ColumnBase<3>&, Real, ColumnMotion&);

}  // namespace talus
