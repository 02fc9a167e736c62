#pragma once
// Pore water: hydrostatic pressure below a given water table, part of the stress of drained bodies.
#include <algorithm>
#include <vector>

#include "core/parallel/threads.hpp"
#include "core/particles.hpp"
#include "mesh/mesh.hpp"
#include "mesh/part.hpp"

namespace talus {

/// A water table that is constant during a stage, while bodies move through it.  Its elevation is given at the nodes and linear in each
/// cell.
struct Water {
  std::vector<Real> table;            ///< elevation of the table at each node [m]; empty without water
  std::vector<std::uint8_t> drained;  ///< whether the law of each body uses effective stress
  Real unit_weight = 0;               ///< unit weight of water [N/m^3]
  Real suction = 0;                   ///< largest suction [Pa]
  bool any() const noexcept { return !table.empty(); }
  bool drains(Index body) const noexcept { return any() && drained[static_cast<std::size_t>(body)] != 0; }
};

/// The depth [m] of a position in a cell, or just beside it, below the water table.  The last coordinate points up.
template <int D>
Real depth_below_table(const Mesh<D>& mesh, const Water& water, Index cell, const Vec<D>& x) noexcept
{
  const auto share = mesh.barycentric(cell, x);
  Real depth = -x[D - 1];
  for (std::size_t a = 0; a <= D; ++a)
    depth += share[a] * water.table[static_cast<std::size_t>(mesh.cell(cell)[a])];
  return depth;
}

/// Pore water while a fraction of gravity acts; the weight of the water has the same factor.
struct PoreWater {
  const Water& water;
  Real share;
  /// The pore pressure [Pa]; negative values are suction.
  template <int D>
  Real pressure(const Mesh<D>& mesh, Index cell, const Vec<D>& x) const noexcept
  {
    return share * std::max(water.unit_weight * depth_below_table(mesh, water, cell, x), -water.suction);
  }
  /// Its gradient [Pa/m].
  template <int D>
  Vec<D> gradient(const Mesh<D>& mesh, Index cell, const Vec<D>& x) const noexcept
  {
    if (water.unit_weight * depth_below_table(mesh, water, cell, x) < -water.suction)
      return Vec<D>::Zero();
    Vec<D> slope = -Vec<D>::Unit(D - 1);
    for (std::size_t a = 0; a <= D; ++a)
      slope += water.table[static_cast<std::size_t>(mesh.cell(cell)[a])] * mesh.gradients(cell)[a];
    return share * water.unit_weight * slope;
  }
};

/// Sets the pore pressure at their present positions of the bodies that follow the table; the effective stress stays.  Directly after a step
/// this changes nothing.  stress_of(body, pressure): the part of it in total stress.
template <int D, class FollowsTable, class StressOf>
void soak(const Mesh<D>& mesh, const PoreWater& now, const std::vector<Body>& bodies, FollowsTable&& follows_table, StressOf&& stress_of,
          Particles<D>& particles)
{
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (follows_table(static_cast<Index>(b)))
      parallel_for(bodies[b].size(), [&](Index i) {
        const auto p = static_cast<std::size_t>(bodies[b].begin + i);
        const Real before = particles.pore[p], pressure = now.pressure(mesh, particles.cell[p], particles.x[p]);
        particles.pore.set(p, stress_of(static_cast<Index>(b), pressure));
        if (!particles.water.empty()) {
          particles.water.set(p, pressure), particles.water_at_rest.set(p, pressure);
          particles.water_gradient.set(p, now.gradient(mesh, particles.cell[p], particles.x[p]));
        }
        particles.stress.set(p, add_diagonal(particles.stress[p], before - particles.pore[p]));
      });
}

/// The part of a water table on one of several ranks.
inline std::vector<Real> part_of_table(const Subdomain& subdomain, const std::vector<Real>& table)
{
  std::vector<Real> held;
  held.reserve(subdomain.node.size());
  for (const Index node : subdomain.node)
    held.push_back(table[static_cast<std::size_t>(node)]);
  return held;
}
inline void restrict_to(const Subdomain& subdomain, Water& water)
{
  if (water.any())
    water.table = part_of_table(subdomain, water.table);
}

}  // namespace talus
