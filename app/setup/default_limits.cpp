#include "app/setup/default_limits.hpp"

#include "core/parallel/threads.hpp"

namespace talus {

namespace {

/// Speeds of waves, and the energy of all particles if they moved with the speed of theirs.
struct Waves {
  Real fastest = 0, energy = 0;  ///< [m/s], [J]
};

template <int D>
Waves waves_in(const Mesh<D>& mesh, const Setup<D>& setup, Communicator& ranks)
{
  const Particles<D>& particles = setup.state.particles;
  CellOrder order;
  sort_by_cell(particles.cell, particles.id, setup.state.bodies, mesh.n_cells(), order);
  Real least = std::numeric_limits<Real>::infinity();  // minus the speed of the fastest
  ExactSums<Real> energy;
  for (Index b = 0; b < static_cast<Index>(setup.state.materials.size()); ++b) {
    const Material& material = setup.state.materials[static_cast<std::size_t>(b)];
    const auto speed = [&](Index i) { return material.wave_speed(i, particles.F[static_cast<std::size_t>(material.begin + i)]); };
    least = parallel_min(material.size(), least, [&](Index i) { return -speed(i); });
    add_particles(order, {b, b + 1}, energy, [&](Index row) {
      const Real c = speed(row - material.begin);
      return 0.5 * particles.mass[static_cast<std::size_t>(row)] * c * c;
    });
  }
  ranks.sum(energy);
  return {std::max(Real{0}, -ranks.min(least)), energy.value()};
}

/// What loads and walls can make of a particle within the mesh [m/s]; infinite where that cannot be told.
template <int D>
Real driven_speed(const Mesh<D>& mesh, const Setup<D>& setup, Communicator& ranks)
{
  if (!setup.conditions.loads.of_place.empty())
    return std::numeric_limits<Real>::infinity();
  const Real size = (mesh.high() - mesh.low()).norm();
  Real speed = 0;
  for (const BoundaryCondition<D>& condition : setup.state.boundary.conditions())
    speed = std::max(speed, condition.peak_speed());
  speed +=
      std::sqrt(2 * setup.conditions.loads.gravity.acceleration.norm() * setup.conditions.loads.gravity.table.largest_magnitude() * size);
  Real pressure = 0;  // on the thinnest layer that carries it, over the size of the mesh
  const auto press = [&](const auto& load) {
    pressure = std::max(pressure, (load.traction.norm() + std::abs(load.pressure)) * load.table.largest_magnitude());
  };
  std::for_each(setup.conditions.loads.on_particles.begin(), setup.conditions.loads.on_particles.end(), press);
  std::for_each(setup.conditions.loads.on_mesh.begin(), setup.conditions.loads.on_mesh.end(), press);
  if (pressure > 0) {
    Real layer = std::numeric_limits<Real>::infinity();  // [kg/m^2]
    for (Index row = 0; row < setup.state.particles.size(); ++row) {
      const auto p = static_cast<std::size_t>(row);
      layer =
          std::min(layer, setup.state.particles.mass[p] / setup.state.particles.volume0[p] * mesh.altitude(setup.state.particles.cell[p]));
    }
    speed += std::sqrt(2 * pressure * size / ranks.min(layer));
  }
  return speed;
}

}  // namespace

template <int D>
RunLimits run_limits_of(const Scene& scene, const Mesh<D>& mesh, const Setup<D>& setup, Communicator& ranks)
{
  constexpr Real far_beyond = 10;
  constexpr Real least_strain = 1e-6;  // waves of less are not looked at
  const Waves waves = waves_in(mesh, setup, ranks);
  Real start = 0;
  for (Index row = 0; row < setup.state.particles.size(); ++row)
    start = std::max(start, setup.state.particles.v[static_cast<std::size_t>(row)].norm());
  start = ranks.max(start);
  const Real fastest = scene.watch.on_speed == LimitAction::ignore || scene.watch.speed ? 0 : driven_speed(mesh, setup, ranks);
  return {scene.watch, far_beyond * (waves.fastest + start + fastest), least_strain * least_strain * waves.energy};
}

template RunLimits run_limits_of<2>(const Scene&, const Mesh<2>&, const Setup<2>&, Communicator&);
template RunLimits run_limits_of<3>(const Scene&, const Mesh<3>&, const Setup<3>&, Communicator&);

}  // namespace talus
