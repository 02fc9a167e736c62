#pragma once
// The algorithm: one explicit step, stress last.  Numbers are those of docs/algorithm.md.
#include <chrono>

#include "solver/average_volume.hpp"
#include "solver/gather.hpp"
#include "solver/model.hpp"

namespace talus {

/// Adds the time since the last lap to a phase.
class StopWatch {
 public:
  void lap(Real& phase) noexcept
  {
    const auto now = Clock::now();
    phase += std::chrono::duration<Real>(now - last_).count();
    last_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

/// Counts what walls did to slaves and hats, which the kinetic energy of nodes knows nothing of.
inline void count_beyond_nodes(const WallWork& work, EnergyLedger& energy) noexcept
{
  energy.walls += work.other;
  energy.friction += work.friction;
  energy.nodes += work.friction + work.other;
}

template <int D, Kernel<D> K>
void sum_on_nodes(Model<D, K>& m);
template <int D, Kernel<D> K>
void settle(Model<D, K>& m, Real dt);
template <int D, Kernel<D> K>
void show_to_particles(Model<D, K>& m, Real dt);
template <int D, Kernel<D> K, class Then>
void remap(Model<D, K>& m, Real dt, Then&& then);
template <int D, Kernel<D> K>
void respond(Model<D, K>& m, Index body, Index block, Real dt);
template <int D, Kernel<D> K>
void respond_as_bodies(Model<D, K>& m, Real dt);

/// One step of length dt [s].  Afterwards `m.health` tells whether the state is sound.
template <int D, Kernel<D> K>
void advance(Model<D, K>& m, Real dt)
{
  StopWatch watch;
  const Real time = m.clock.time, ramp = m.stage.ramp(time + dt);
  const Vec<D> gravity = m.loads.gravity(time + dt, ramp);

  if (relocate(m.mesh, m.locator, m.exits, m.bodies, m.materials, m.particles, m.order, m.mass, m.energy, m.health))  //  1
    index_rows(m);
  if (m.health.worst())
    return;
  const Push<D> on_particles = apply(m.loads, time + dt, ramp, m.row_of_id, m.particles);  //  2
  watch.lap(m.timings.locate);

  scatter(m);  //  3
  watch.lap(m.timings.scatter);

  sum_on_nodes(m);  //  4
  const Push<D> on_mesh = apply(m.loads, time + dt, ramp, m.mesh, std::span(m.nodes.sum));
  m.slaves.lump(m.mesh, m.nodes);                                //  5
  integrate(gravity, dt, m.nodes);                               //  6
  const WallWork wall_work = m.walls.apply(time + dt, m.nodes);  //  7
  if (m.stage.seeks_rest)
    settle(m, dt);
  count_beyond_nodes(m.slaves.follow(m.mesh, m.nodes, time + dt, m.walls, m.nodes.motion), m.energy);  //  8
  record(m, gravity, on_particles + on_mesh, wall_work, dt);
  m.energy.loads += work(m.loads, time + dt, ramp, dt, m.nodes);
  watch.lap(m.timings.nodes);

  show_to_particles(m, dt);  //  9
  const auto stress = [&](Index body, Index block) { respond(m, body, block, dt); };
  m.stress_sums.assign(m.order.first.size(), {});
  if (m.transfer.musl) {
    gather_and_return_momentum(m, dt);  // 10
    remap(m, dt, stress);               // 11, 12
  } else {
    gather(m, dt, stress);  // 10, 12
  }
  m.energy.loads += work(m.particles);
  respond_as_bodies(m, dt);
  watch.lap(m.timings.gather);  // its share of stresses is told apart by respond_as_bodies()

  m.clock = {m.clock.step + 1, time + dt, dt};
  m.timings.particle_steps += static_cast<Real>(m.particles.size());
}

/// Rows of blocks -> nodes; with a node part, hats stand between.
template <int D, Kernel<D> K>
void sum_on_nodes(Model<D, K>& m)
{
  if constexpr (HasNodePart<K, D>) {
    assemble(m.blocks, m.hats.sum);
    collect(m.kernel.node_part(), m.mesh, m.hats.sum, !HasOwnValues<K, D>, m.nodes.sum);
  } else {
    assemble(m.blocks, m.nodes.sum);
  }
}

/// Local damping, by what particles feel of the net acceleration: all of it but where operators stand between nodes and values.
template <int D, Kernel<D> K>
void settle(Model<D, K>& m, Real dt)
{
  find_net_acceleration(dt, m.nodes);
  if constexpr (HasNodePart<K, D> && !HasOwnValues<K, D>)
    feel(m.kernel.node_part(), m.hats, m.nodes.felt);
  if (m.stage.damping > 0)
    damp(m.stage.damping, dt, m.nodes);
}

/// Motion of the nodes -> what particles read: the same, or hats, on which walls act once more where their values mix those of nodes.
template <int D, Kernel<D> K>
void show_to_particles([[maybe_unused]] Model<D, K>& m, [[maybe_unused]] Real dt)
{
  if constexpr (HasNodePart<K, D>) {
    spread(m.kernel.node_part(), m.nodes.motion, m.hats);
    if constexpr (!HasOwnValues<K, D>)
      count_beyond_nodes(m.walls.apply(m.clock.time + dt, m.hats.sum, m.hats.motion), m.energy);
  }
}

/// MUSL: momentum of the new particle velocities on the nodes, held by the walls; then L_p from these velocities, while the
/// particles move with those of the step itself.
template <int D, Kernel<D> K, class Then>
void remap(Model<D, K>& m, Real dt, Then&& then)
{
  if constexpr (HasNodePart<K, D>) {
    assemble_momentum(m.blocks, m.hats.sum);
    collect_momentum(m.kernel.node_part(), m.mesh, m.hats.sum, m.nodes.sum);
  } else {
    assemble_momentum(m.blocks, m.nodes.sum);
  }
  m.slaves.lump_momentum(m.mesh, m.nodes);
  parallel_for(static_cast<Index>(m.remapped.size()), [&](Index n) {
    const auto i = static_cast<std::size_t>(n);
    const Vec<D> v = m.nodes.active[i] ? Vec<D>(m.nodes.sum[i].momentum / m.nodes.sum[i].mass) : Vec<D>(Vec<D>::Zero());
    m.remapped[i] = {v, m.nodes.motion[i].v};
  });
  m.walls.hold(m.clock.time + dt, m.remapped);
  m.slaves.follow_velocity(m.mesh, m.nodes, m.walls, m.clock.time + dt, m.remapped);
  if constexpr (HasNodePart<K, D>) {
    spread_gradient(m.kernel.node_part(), m.remapped, m.hats);
    gather_gradient(m, m.hats.motion, dt, then);
  } else {
    gather_gradient(m, m.remapped, dt, then);
  }
}

/// Stress of the particles of a body in a block, unless their law must know those of other blocks first.
template <int D, Kernel<D> K>
void respond(Model<D, K>& m, Index body, Index block, Real dt)
{
  AnyBatch& material = m.materials[static_cast<std::size_t>(body)];
  if (const auto rows = m.order.rows(body, block); !rows.empty() && !averages_volume(material))
    m.stress_sums[m.order.key(body, block)] = update_stress(m.mesh, material, rows, dt, m.stage.elastic, m.averaged, m.particles, m.health);
}

/// What is of a body as a whole: volumes averaged before the stress, heat after it; and the sums of the step.
template <int D, Kernel<D> K>
void respond_as_bodies(Model<D, K>& m, Real dt)
{
  StressSums total;
  for (Index body = 0; body < m.n_bodies(); ++body) {
    AnyBatch& material = m.materials[static_cast<std::size_t>(body)];
    if (averages_volume(material)) {
      average_volume(m.mesh, m.order, body, dt, m.particles, *m.stars, m.averaged);
      parallel_for_uneven(m.order.blocks, [&](Index block) {
        m.stress_sums[m.order.key(body, block)] =
            update_stress(m.mesh, material, m.order.rows(body, block), dt, m.stage.elastic, m.averaged, m.particles, m.health);
      });
    }
    if (m.heat)
      conduct_heat(m.mesh, material, m.order, body, dt, m.particles, *m.heat);
    for (Index block = 0; block < m.order.blocks; ++block)
      total += m.stress_sums[m.order.key(body, block)];
  }
  m.energy.internal += total.work;
  m.crossing = total.crossing;
  m.watched.speed = total.speed;
  m.timings.stress += total.seconds / threads();
  m.timings.gather -= total.seconds / threads();
}

/// Work, impulses and residual of the step, for the audit.
template <int D, Kernel<D> K>
void record(Model<D, K>& m, const Vec<D>& gravity, const Push<D>& tractions, const WallWork& wall_work, Real dt)
{
  const NodeWork<D> work = node_work(gravity, m.stage.damping, dt, m.mesh, m.nodes);
  m.mass.on_nodes = work.mass;
  m.momentum.loads += Push<D>::of(dt * work.mass * gravity, dt * moment<D>(work.first_moment, gravity)) + dt * tractions;
  m.momentum.damping += work.damped;
  m.energy.gravity += work.gravity;
  m.energy.damping += work.damping;
  m.energy.walls += wall_work.other;
  m.energy.friction += wall_work.friction;
  m.energy.nodes += work.kinetic_after - work.kinetic_before;
  m.residual = unbalanced(gravity, m.stage.seeks_rest, dt, m.nodes, tractions.size);
}

}  // namespace talus
