#pragma once
// Water in the pores: hydrostatic pressure under a table that is given, part of the stress of drained bodies.
#include <algorithm>
#include <optional>
#include <vector>

#include "core/parallel/threads.hpp"
#include "core/particles.hpp"
#include "mesh/mesh.hpp"
#include "mesh/part.hpp"

namespace talus {

/// A table that stays where it is during a stage, while bodies move through it.  Its elevation is known at the nodes and linear between them, like the mesh.
struct Water {
  std::vector<Real> table;            ///< elevation [m] at each node; empty where there is no water
  std::vector<std::uint8_t> drained;  ///< of each body: whether its law sees effective stress
  Real unit_weight = 0;               ///< [N/m^3]
  Real suction = 0;                   ///< largest one [Pa]
  bool any() const noexcept { return !table.empty(); }
  bool drains(Index body) const noexcept { return any() && drained[static_cast<std::size_t>(body)] != 0; }
};

/// How far a place in a cell, or just beside it, lies below the table [m].  The last coordinate points up.
template <int D>
Real depth_below_table(const Mesh<D>& mesh, const Water& water, Index cell, const Vec<D>& x) noexcept
{
  const auto share = mesh.barycentric(cell, x);
  Real depth = -x[D - 1];
  for (std::size_t a = 0; a <= D; ++a)
    depth += share[a] * water.table[static_cast<std::size_t>(mesh.cell(cell)[a])];
  return depth;
}

/// Water while a share of gravity acts: as this grows from nothing, so does the weight of the water.
struct PoreWater {
  const Water& water;
  Real share;
  /// Pore pressure [Pa]; < 0 is suction.
  template <int D>
  Real pressure(const Mesh<D>& mesh, Index cell, const Vec<D>& x) const noexcept
  {
    return share * std::max(water.unit_weight * depth_below_table(mesh, water, cell, x), -water.suction);
  }
};

/// Drained bodies get the pore pressure of where they are; their effective stress stays.  After a step this changes nothing.
template <int D>
void soak(const Mesh<D>& mesh, const PoreWater& now, const std::vector<Body>& bodies, Particles<D>& particles)
{
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (now.water.drains(static_cast<Index>(b)))
      parallel_for(bodies[b].size(), [&](Index i) {
        const auto p = static_cast<std::size_t>(bodies[b].begin + i);
        const Real before = particles.pore[p];
        particles.pore.set(p, now.pressure(mesh, particles.cell[p], particles.x[p]));
        particles.stress.set(p, add_diagonal(particles.stress[p], before - particles.pore[p]));
      });
}

/// What one of several ranks holds of a table.
inline std::vector<Real> part_of_table(const Subdomain& share, const std::vector<Real>& table)
{
  std::vector<Real> held;
  held.reserve(share.node.size());
  for (const Index node : share.node)
    held.push_back(table[static_cast<std::size_t>(node)]);
  return held;
}
inline void restrict_to(const Subdomain& share, Water& water)
{
  if (water.any())
    water.table = part_of_table(share, water.table);
}

}  // namespace talus
