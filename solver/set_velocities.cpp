#include "solver/set_velocities.hpp"

#include <algorithm>

#include "solver/stable_step.hpp"

namespace talus {

template <int D>
void set_velocities(Model<D>& m, std::span<const Real> values, VelocityChange change)
{
  end_sweeps(m);
  Particles<D>& particles = m.state.particles;
  const Real kinetic_before = totals(m).kinetic;
  ExactSums<ForceAndMoment<D>> momentum;
  for (std::size_t row = 0; row < particles.id.size(); ++row) {
    const Vec<D> v = Eigen::Map<const Vec<D>>(values.data() + row * D);
    momentum.add(ForceAndMoment<D>::at(particles.x[row], particles.mass[row] * (v - particles.v[row])));
    particles.v.set(row, v);
  }
  // The next step is bounded by the new speeds as well.
  m.state.crossing = std::min(m.state.crossing, shortest_crossing(m.problem.mesh, m.state.materials, particles));
  const Real gain = totals(m).kinetic - kinetic_before;
  EnergyLedger& energy = m.state.energy;
  if (change == VelocityChange::at_start) {
    energy.kinetic_start += gain;
    return;
  }
  energy.loads += gain;
  energy.nodes += gain;  // nodes have the new velocities from the next step on; that is no loss between particles and nodes
  m.state.momentum.changes += momentum.value();
}

template void set_velocities(Model<2>&, std::span<const Real>, VelocityChange);
template void set_velocities(Model<3>&, std::span<const Real>, VelocityChange);

}  // namespace talus
