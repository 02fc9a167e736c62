#pragma once
// How long a step may be: a share of the time in which a wave crosses the cell of a particle.
#include "solver/update_stress.hpp"

namespace talus {

/// The crossing_time of one particle.
template <int D, class L>
Real crossing_time_of(const Mesh<D>& mesh, const Batch<L>& batch, const Particles<D>& particles, Index i)
{
  const auto p = static_cast<std::size_t>(batch.begin + i);
  return crossing_time<D>(batch, mesh.altitude(particles.cell[p]), particles.v[p].norm(), batch.wave_speed(i, particles.F[p]),
                          std::max(-particles.L[p].trace(), Real{0}));
}

/// Smallest crossing_time over all particles [s]; infinite without particles.  Every step
/// finds it anew while it has the particles at hand (update_stress); this is for the first one.
template <int D>
Real shortest_crossing(const Mesh<D>& mesh, const std::vector<AnyBatch>& materials, const Particles<D>& particles)
{
  Real least = std::numeric_limits<Real>::infinity();
  for (const auto& material : materials)
    std::visit(
        [&](const auto& batch) {
          least = parallel_min(batch.size(), least, [&](Index i) { return crossing_time_of(mesh, batch, particles, i); });
        },
        material);
  return least;
}

/// The particle that asks for the shortest step: row, for messages.
template <int D>
Index slowest_particle(const Mesh<D>& mesh, const std::vector<AnyBatch>& materials, const Particles<D>& particles)
{
  Index slowest = none;
  Real least = std::numeric_limits<Real>::infinity();
  for (const auto& material : materials)
    std::visit(
        [&](const auto& batch) {
          for (Index row = batch.begin; row < batch.end; ++row) {
            const Real own = crossing_time_of(mesh, batch, particles, row - batch.begin);
            if (own < least) {
              least = own;
              slowest = row;
            }
          }
        },
        material);
  return slowest;
}

}  // namespace talus
