#pragma once
// How long a step may be: a share of the time in which a wave crosses the cell of a particle.
#include "solver/update_stress.hpp"

namespace talus {

/// Smallest crossing_time over all particles [s]; infinite without particles.  Every step
/// finds it anew while it has the particles at hand (update_stress); this is for the first one.
template <int D>
Real shortest_crossing(const Mesh<D>& mesh, const std::vector<AnyBatch>& materials, const Particles<D>& particles)
{
  Real least = std::numeric_limits<Real>::infinity();
  for (const auto& material : materials)
    std::visit(
        [&](const auto& batch) {
          least = parallel_min(batch.size(), least, [&](Index i) {
            const auto p = static_cast<std::size_t>(batch.begin + i);
            return crossing_time(mesh, batch, particles, p, batch.wave_speed(i, particles.F[p]),
                                 std::max(-particles.L[p].trace(), Real{0}));
          });
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
            const auto p = static_cast<std::size_t>(row);
            const Real own = crossing_time(mesh, batch, particles, p, batch.wave_speed(row - batch.begin, particles.F[p]),
                                           std::max(-particles.L[p].trace(), Real{0}));
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
