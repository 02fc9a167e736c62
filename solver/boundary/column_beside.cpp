#include "solver/boundary/column_beside.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/parallel/exact_sum.hpp"
#include "materials/interface/varied_law.hpp"

namespace talus {

namespace {

/// Sums over the particles in the cells behind the facets of a layer.
struct LayerContent {
  Real mass{}, volume{};     ///< [kg] and [m^3]
  Real shear{}, confined{};  ///< moduli times volume [N m]
};

}  // namespace

template <int D>
std::optional<SoilColumn<D>> column_beside(const Mesh<D>& mesh, std::span<const Facet> facets, const Vec<D>& up,
                                           const Particles<D>& particles, std::span<const Material> materials, Communicator& ranks)
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
  constexpr Real apart = 0.3;  // smallest distance of levels, relative to the height of a facet: in an unstructured mesh hardly any two
                               // nodes are at the same height
  for (const Real height : heights)
    if (column.level.empty() || height > column.level.back() + apart * mean)
      column.level.push_back(height);
  if (column.level.size() < 2)
    return std::nullopt;
  column.level.back() = heights.back();
  column.layer.resize(column.level.size() - 1);

  std::map<Index, std::size_t> layer_of_cell;
  std::vector<Real> capacity(column.layer.size(), 0);  // [m^3]
  for (const Facet facet : facets) {
    Real height = 0;
    for (const Index n : mesh.nodes_of(facet))
      height += up.dot(mesh.node(n)) / D;
    const std::size_t layer = column.layer_at(height);
    if (layer_of_cell.try_emplace(facet.cell, layer).second)
      capacity[layer] += mesh.volume(facet.cell);
  }
  std::vector<ExactSums<LayerContent>> sums(column.layer.size());
  std::int64_t without_modulus = 0;
  for (const Material& material : materials)
    for (Index p = material.begin; p < material.end; ++p) {
      const auto i = static_cast<std::size_t>(p);
      const auto at = layer_of_cell.find(particles.cell[i]);
      if (at == layer_of_cell.end())
        continue;
      const Real mass = particles.mass[i], volume = particles.volume0[i];
      const Real c = material.wave_speed(p - material.begin, particles.F[i]);
      if (const auto shear = shear_modulus_of(material, p - material.begin))
        sums[at->second].add({mass, volume, volume * *shear, mass * c * c});
      else
        ++without_modulus;
    }
  ranks.sum(std::span(sums));
  if (ranks.sum(without_modulus) > 0)
    return std::nullopt;
  std::size_t top = 0;
  constexpr Real least_filled = 1e-3;
  for (; top < column.layer.size(); ++top) {
    const LayerContent content = sums[top].value();
    const Real filled = content.volume / capacity[top];
    if (!(filled > least_filled))
      break;
    const Real density = content.mass / content.volume;
    column.layer[top] = {{density, std::sqrt(content.shear / content.mass), std::sqrt(content.confined / content.mass)},
                         std::min(filled, Real{1})};
  }
  column.layer.resize(top);
  column.level.resize(top + 1);
  return top > 0 ? std::optional(std::move(column)) : std::nullopt;
}

template std::optional<SoilColumn<2>> column_beside<2>(const Mesh<2>&, std::span<const Facet>, const Vec<2>&, const Particles<2>&,
                                                       std::span<const Material>, Communicator&);
template std::optional<SoilColumn<3>> column_beside<3>(const Mesh<3>&, std::span<const Facet>, const Vec<3>&, const Particles<3>&,
                                                       std::span<const Material>, Communicator&);

}  // namespace talus
