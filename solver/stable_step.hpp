#pragma once
// How long a step may be: a share of the time in which a wave crosses the cell of a particle.
#include "core/parallel/threads.hpp"
#include "materials/interface/material.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// The crossing_time of one particle.
template <int D>
Real crossing_time_of(const Mesh<D>& mesh, const Material& material, const Particles<D>& particles, Index i)
{
  const auto p = static_cast<std::size_t>(material.begin + i);
  return crossing_time<D, Real>(material.law().diffusivity(), material.viscosity, mesh.altitude(particles.cell[p]), particles.v[p].norm(),
                                material.wave_speed(i, particles.F[p]), std::max(-particles.L[p].trace(), Real{0}));
}

/// Smallest crossing_time over all particles [s]; infinite without particles.  Every step
/// finds it anew while it has the particles at hand (update_stress); this is for the first one.
template <int D>
Real shortest_crossing(const Mesh<D>& mesh, const std::vector<Material>& materials, const Particles<D>& particles)
{
  Real least = std::numeric_limits<Real>::infinity();
  for (const auto& material : materials)
    least = parallel_min(material.size(), least, [&](Index i) { return crossing_time_of(mesh, material, particles, i); });
  return least;
}

/// Least altitude of a cell that holds a particle [m]; infinite without particles.
template <int D>
Real least_altitude(const Mesh<D>& mesh, const Particles<D>& particles)
{
  return parallel_min(particles.size(), std::numeric_limits<Real>::infinity(),
                      [&](Index row) { return mesh.altitude(particles.cell[static_cast<std::size_t>(row)]); });
}
/// Largest force over mass of a particle, of forces of loads [m/s^2].
template <int D>
Real largest_pull(const Particles<D>& particles)
{
  return particles.applied.empty() ? 0 : -parallel_min(particles.size(), Real{0}, [&](Index row) {
    const auto p = static_cast<std::size_t>(row);
    return -particles.applied[p].norm() / particles.mass[p];
  });
}

/// A particle of this rank, or none, and what it was chosen for.
struct Chosen {
  Index row = none;
  Real value = std::numeric_limits<Real>::infinity();
};
/// The better of two, of equals the one with the lower id: rows may stand in any order.
template <int D>
Chosen lesser(const Particles<D>& particles, const Chosen& a, const Chosen& b) noexcept
{
  const auto id = [&](const Chosen& one) {
    return one.row == none ? std::numeric_limits<std::int64_t>::max() : particles.id[static_cast<std::size_t>(one.row)];
  };
  return std::pair(b.value, id(b)) < std::pair(a.value, id(a)) ? b : a;
}

/// The particle that asks for the shortest step, with its crossing_time.
template <int D>
Chosen slowest_particle(const Mesh<D>& mesh, const std::vector<Material>& materials, const Particles<D>& particles)
{
  Chosen slowest;
  for (const auto& material : materials)
    for (Index row = material.begin; row < material.end; ++row)
      slowest = lesser(particles, slowest, {row, crossing_time_of(mesh, material, particles, row - material.begin)});
  return slowest;
}
/// The fastest one, with minus the square of its speed.
template <int D>
Chosen fastest_particle(const Particles<D>& particles)
{
  Chosen fastest;
  for (Index row = 0; row < particles.size(); ++row)
    fastest = lesser(particles, fastest, {row, -particles.v[static_cast<std::size_t>(row)].squaredNorm()});
  return fastest;
}

}  // namespace talus
