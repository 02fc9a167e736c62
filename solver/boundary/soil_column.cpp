#include "solver/boundary/soil_column.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/parallel/exact_sum.hpp"

namespace talus {

namespace {

template <int D>
auto row(std::vector<Real>& numbers, std::size_t i)
{
  return Eigen::Map<Vec<D>>(&numbers[D * i]);
}
template <int D>
auto row(const std::vector<Real>& numbers, std::size_t i)
{
  return Eigen::Map<const Vec<D>>(&numbers[D * i]);
}

/// [Pa]
Real shear_modulus(const Halfspace& ground) { return ground.density * ground.s_wave * ground.s_wave; }
Real confined_modulus(const Halfspace& ground) { return ground.density * ground.p_wave * ground.p_wave; }

/// Behind the facets of a layer.
struct Content {
  Real mass{}, volume{};     ///< [kg], [m^3]
  Real shear{}, confined{};  ///< moduli times volume [N m]
};

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
  return (1 - share) * row<D>(motion.velocity, l) + share * row<D>(motion.velocity, l + 1);
}

/// Stress of a motion u(h): along the axis a of the column lambda a.u' in all directions and 2 mu a.u' along a, and mu between a and the
/// rest of u'.  With n across a its traction is (lambda a.u') n + (mu n.u') a, and the traction on horizontal planes gives both terms.
template <int D>
Vec<D> SoilColumn<D>::force_on(const Vec<D>& area, std::size_t at_layer, const ColumnMotion& motion) const noexcept
{
  const Layer& here = layer[at_layer];
  const Vec<D> t = row<D>(motion.traction, at_layer);
  const Real lambda_share = 1 - 2 * shear_modulus(here.ground) / confined_modulus(here.ground);
  return here.filled * (lambda_share * t.dot(up) * area + t.dot(area) * up);
}

template <int D>
void advance(const SoilColumn<D>& column, const Foot<D>& foot, Real dt, ColumnMotion& motion)
{
  const std::size_t n = column.layer.size();
  constexpr Real safe = 0.5;  // share of the time in which a wave crosses a layer
  Real longest = std::numeric_limits<Real>::infinity();
  const auto thickness = [&](std::size_t l) { return column.level[l + 1] - column.level[l]; };
  for (std::size_t l = 0; l < n; ++l)
    longest = std::min(longest, safe * thickness(l) / column.layer[l].ground.p_wave);
  const auto parts = std::max(1, static_cast<int>(std::ceil(dt / longest)));
  const Real step = dt / parts;
  const auto mass = [&](std::size_t l) { return column.layer[l].filled * column.layer[l].ground.density * thickness(l) / 2; };
  for (int part = 0; part < parts; ++part) {
    for (std::size_t i = 0; i <= n; ++i) {
      Real m = 0;  // per area, of this level
      Vec<D> force = Vec<D>::Zero();
      if (i > 0)
        m += mass(i - 1), force -= column.layer[i - 1].filled * row<D>(motion.traction, i - 1);
      if (i < n)
        m += mass(i), force += column.layer[i].filled * row<D>(motion.traction, i);
      auto v = row<D>(motion.velocity, i);
      if (i > 0) {
        v += step / m * force;
      } else if (foot.halfspace) {  // as the model's own base, see
                                    // Walls::give_way
        const Mat<D> resistance = impedance<D>(*foot.halfspace, column.up);
        v = (m * Mat<D>::Identity() + step * resistance).inverse() * (m * v + step * (force + resistance * foot.velocity * 2)).eval();
      } else {
        v = foot.velocity;
      }
    }
    for (std::size_t l = 0; l < n; ++l) {
      const Halfspace& ground = column.layer[l].ground;
      const Vec<D> strain = (row<D>(motion.velocity, l + 1) - row<D>(motion.velocity, l)) * (step / thickness(l));
      row<D>(motion.traction, l) +=
          shear_modulus(ground) * strain + (confined_modulus(ground) - shear_modulus(ground)) * strain.dot(column.up) * column.up;
    }
  }
}

template <int D>
std::optional<SoilColumn<D>> column_beside(const Mesh<D>& mesh, std::span<const Facet> facets, const Vec<D>& up,
                                           const Particles<D>& particles, std::span<const AnyBatch> materials, Communicator& ranks)
{
  SoilColumn<D> column;
  column.up = up;
  std::vector<Real> heights;
  Real mean = 0;
  for (const Facet facet : facets) {
    Real low = std::numeric_limits<Real>::infinity(), high = -low;
    for (const Index n : mesh.nodes_of(facet)) {
      heights.push_back(up.dot(mesh.node(n)));
      low = std::min(low, heights.back()), high = std::max(high, heights.back());
    }
    mean += (high - low) / static_cast<Real>(facets.size());
  }
  std::sort(heights.begin(), heights.end());
  constexpr Real apart = 0.3;  // of a facet: nodes of an unstructured mesh in
                               // 3-D are hardly ever at the same height
  for (const Real height : heights)
    if (column.level.empty() || height > column.level.back() + apart * mean)
      column.level.push_back(height);
  if (column.level.size() < 2)
    return std::nullopt;
  column.level.back() = heights.back();
  column.layer.resize(column.level.size() - 1);

  std::map<Index, std::size_t> layer_of_cell;
  std::vector<Real> room(column.layer.size(), 0);  // [m^3]
  for (const Facet facet : facets) {
    Real height = 0;
    for (const Index n : mesh.nodes_of(facet))
      height += up.dot(mesh.node(n)) / D;
    const std::size_t layer = column.layer_at(height);
    if (layer_of_cell.try_emplace(facet.cell, layer).second)
      room[layer] += mesh.volume(facet.cell);
  }
  std::vector<ExactSums<Content>> sums(column.layer.size());
  std::int64_t without_modulus = 0;
  for (const AnyBatch& material : materials)
    std::visit(
        [&](const auto& batch) {
          for (Index p = batch.begin; p < batch.end; ++p) {
            const auto i = static_cast<std::size_t>(p);
            const auto at = layer_of_cell.find(particles.cell[i]);
            if (at == layer_of_cell.end())
              continue;
            const Real mass = particles.mass[i], volume = particles.volume0[i];
            const Real c = batch.wave_speed(p - batch.begin, particles.F[i]);
            if constexpr (requires { batch.constants.shear; })
              sums[at->second].add({mass, volume, volume * batch.constants.shear, mass * c * c});
            else
              ++without_modulus;
          }
        },
        material);
  ranks.sum(std::span(sums));
  if (ranks.sum(without_modulus) > 0)
    return std::nullopt;
  std::size_t top = 0;
  constexpr Real next_to_nothing = 1e-3;
  for (; top < column.layer.size(); ++top) {
    const Content content = sums[top].value();
    const Real filled = content.volume / room[top];
    if (!(filled > next_to_nothing))
      break;
    const Real density = content.mass / content.volume;
    column.layer[top] = {{density, std::sqrt(content.shear / content.mass), std::sqrt(content.confined / content.mass)},
                         std::min(filled, Real{1})};
  }
  column.layer.resize(top);
  column.level.resize(top + 1);
  return top > 0 ? std::optional(std::move(column)) : std::nullopt;
}

template struct SoilColumn<2>;
template struct SoilColumn<3>;
template void advance<2>(const SoilColumn<2>&, const Foot<2>&, Real, ColumnMotion&);
template void advance<3>(const SoilColumn<3>&, const Foot<3>&, Real, ColumnMotion&);
template std::optional<SoilColumn<2>> column_beside<2>(const Mesh<2>&, std::span<const Facet>, const Vec<2>&, const Particles<2>&,
                                                       std::span<const AnyBatch>, Communicator&);
template std::optional<SoilColumn<3>> column_beside<3>(const Mesh<3>&, std::span<const Facet>, const Vec<3>&, const Particles<3>&,
                                                       std::span<const AnyBatch>, Communicator&);

}  // namespace talus
