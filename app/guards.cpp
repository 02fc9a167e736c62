#include "app/guards.hpp"

#include "core/parallel.hpp"

namespace talus {

namespace {

Real largest_factor(const Table& table)
{
  Real largest = table.points.empty() ? 1 : 0;
  for (const auto& [time, value] : table.points)
    largest = std::max(largest, std::abs(value));
  return largest;
}

/// Speeds of waves, and the energy of all particles if they moved with the speed of theirs.
struct Waves {
  Real fastest = 0, energy = 0;  ///< [m/s], [J]
  Waves& operator+=(const Waves& other) noexcept
  {
    fastest = std::max(fastest, other.fastest), energy += other.energy;
    return *this;
  }
};

template <int D>
Waves waves_in(const Setup<D>& setup)
{
  Waves all;
  for (const AnyBatch& material : setup.materials)
    std::visit(
        [&](const auto& batch) {
          all += parallel_sum<Waves>(batch.size(), [&](Index i) {
            const auto p = static_cast<std::size_t>(batch.begin + i);
            const Real c = batch.wave_speed(i, setup.particles.F[p]);
            return Waves{c, 0.5 * setup.particles.mass[p] * c * c};
          });
        },
        material);
  return all;
}

/// What loads and walls can make of a particle within the mesh [m/s]; infinite where that cannot be told.
template <int D>
Real driven_speed(const Mesh<D>& mesh, const Setup<D>& setup)
{
  if (!setup.loads.of_place.empty())
    return std::numeric_limits<Real>::infinity();
  const Real size = (mesh.high() - mesh.low()).norm();
  Real speed = 0;
  for (const Wall<D>& wall : setup.walls.walls())
    speed = std::max(speed, wall.velocity.norm() * largest_factor(wall.table));
  speed += std::sqrt(2 * setup.loads.gravity.acceleration.norm() * largest_factor(setup.loads.gravity.table) * size);
  Real pressure = 0;  // on the thinnest layer that carries it, over the size of the mesh
  const auto press = [&](const auto& load) {
    pressure = std::max(pressure, (load.traction.norm() + std::abs(load.pressure)) * largest_factor(load.table));
  };
  std::for_each(setup.loads.on_particles.begin(), setup.loads.on_particles.end(), press);
  std::for_each(setup.loads.on_mesh.begin(), setup.loads.on_mesh.end(), press);
  if (pressure > 0) {
    Real layer = std::numeric_limits<Real>::infinity();  // [kg/m^2]
    for (Index row = 0; row < setup.particles.size(); ++row) {
      const auto p = static_cast<std::size_t>(row);
      layer = std::min(layer, setup.particles.mass[p] / setup.particles.volume0[p] * mesh.altitude(setup.particles.cell[p]));
    }
    speed += std::sqrt(2 * pressure * size / layer);
  }
  return speed;
}

}  // namespace

template <int D>
Guards guards_of(const Scene& scene, const Mesh<D>& mesh, const Setup<D>& setup)
{
  constexpr Real far_beyond = 10;
  constexpr Real least_strain = 1e-6;  // waves of less are not looked at
  const WatchSpec& spec = scene.watch;
  const Waves waves = waves_in(setup);
  Real start = 0;
  for (Index row = 0; row < setup.particles.size(); ++row)
    start = std::max(start, setup.particles.v[static_cast<std::size_t>(row)].norm());
  Guards guards;
  if (spec.on_speed != OnAlarm::ignore)
    guards.speed = spec.speed.value_or(far_beyond * (waves.fastest + start + driven_speed(mesh, setup)));
  if (spec.on_energy_gain != OnAlarm::ignore)
    guards.gain = spec.energy_gain;
  if (spec.on_failure == OnFailure::remove)
    guards.failed = spec.failed_mass;
  guards.speed_stops = spec.on_speed == OnAlarm::stop;
  guards.gain_stops = spec.on_energy_gain == OnAlarm::stop;
  guards.least_energy = least_strain * least_strain * waves.energy;
  return guards;
}

template Guards guards_of<2>(const Scene&, const Mesh<2>&, const Setup<2>&);
template Guards guards_of<3>(const Scene&, const Mesh<3>&, const Setup<3>&);

}  // namespace talus
