#pragma once
// The algorithm: one explicit step, stress last.  Numbers are those of docs/theory/algorithm.md.
#include <chrono>

#include "solver/gather.hpp"
#include "solver/model.hpp"
#include "solver/stress/average_volume.hpp"

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

template <int D, Kernel<D> K>
void locate_particles(Model<D, K>& m);
template <int D, Kernel<D> K>
void assemble_nodes(Model<D, K>& m);
template <int D, Kernel<D> K>
void damp_towards_rest(Model<D, K>& m);
template <int D, Kernel<D> K>
void project_to_particles(Model<D, K>& m, const Kick& kick);
template <int D, Kernel<D> K, class Then>
void remap(Model<D, K>& m, Real mid, Real dt, Then&& then);
template <int D, Kernel<D> K>
void update_stress_block(Model<D, K>& m, Index body, Index block, Real dt);
template <int D, Kernel<D> K>
void update_stress_bodies(Model<D, K>& m, Real dt);
template <int D, Kernel<D> K>
bool particles_valid(Model<D, K>& m);
template <int D, Kernel<D> K>
void count(Model<D, K>& m);
template <int D, Kernel<D> K>
void update_balances(Model<D, K>& m);

/// One step of length dt [s] from t = m.clock.time on: a leap-frog.  Places, stress and all loads are those of t; forces act from the time
/// of the old velocities, t - m.clock.lag, to that of the new ones, t + dt/2, for which walls and waves prescribe theirs; with these
/// velocities everything moves and strains from t to t + dt.  Afterwards `m.health` tells whether the state is sound.
template <int D, Kernel<D> K>
void advance(Model<D, K>& m, Real dt)
{
  StopWatch watch;
  const Real time = m.clock.time, ramp = m.stage.ramp(time);
  const Kick kick{time - m.clock.lag, time + dt / 2};
  const Vec<D> gravity = m.loads.gravity(time, ramp);

  m.sums.clear();
  locate_particles(m);  //  1
  if (!particles_valid(m))
    return;
  apply(m.loads, time, ramp, m.followed, m.order, m.particles, m.sums.on_particles);  //  2
  watch.lap(m.timings.locate);

  scatter(m);  //  3
  watch.lap(m.timings.scatter);

  assemble_nodes(m);  //  4
  apply(m.loads, time, ramp, m.mesh, m.own, std::span(m.nodes.sum), m.sums.on_mesh);
  m.small_mass_nodes.lump(m.mesh, m.own, m.nodes);         //  5
  integrate(gravity, m.clock.lag + dt / 2, m.nodes);       //  6
  m.walls.apply_dashpots(kick.to, dt, *m.ranks, m.nodes);  //  7
  m.walls.apply(kick, m.nodes, m.sums.at_nodes);           //  7
  if (m.stage.seeks_rest)
    damp_towards_rest(m);
  m.small_mass_nodes.extrapolate(m.mesh, m.own, kick, m.walls, m.nodes.motion, m.sums.beyond_nodes);  //  8
  m.copies.motion.send(m.nodes.motion, Whole{});
  count(m);
  add_work(m.loads, time, ramp, m.own, m.nodes, m.sums.work_on_mesh);
  watch.lap(m.timings.nodes);

  project_to_particles(m, kick);  //  9
  const auto stress = [&](Index body, Index block) { update_stress_block(m, body, block, dt); };
  m.stress_sums.assign(m.order.first.size(), {});
  if (m.transfer.musl) {
    gather_and_return_momentum(m, dt);  // 10
    remap(m, kick.to, dt, stress);      // 11, 12
  } else {
    gather(m, dt, stress);  // 10, 12
  }
  add_work(m.order, m.particles, m.sums.work_on_particles);
  update_stress_bodies(m, dt);
  update_balances(m);
  watch.lap(m.timings.gather);  // its share of stresses is told apart by respond_as_bodies()

  m.clock = {.step = m.clock.step + 1, .time = time + dt, .dt = dt, .lag = dt / 2};
}

/// Cells, ranks and rows of the particles.
template <int D, Kernel<D> K>
void locate_particles(Model<D, K>& m)
{
  bool changed = relocate(m.mesh, m.locator, m.exits, m.bodies, m.materials, m.particles, m.order, m.sums, m.health);
  changed |= m.migration(m.share, m.bodies, m.materials, m.particles, m.order);
  changed |= sort_by_cell(m.bodies, m.materials, m.particles, m.order);
  if (changed)
    update_tracked_rows(m);
}

/// Rows of blocks -> nodes; with a node part, hats stand between.
template <int D, Kernel<D> K>
void assemble_nodes(Model<D, K>& m)
{
  if constexpr (HasNodeOperators<K, D>) {
    assemble<Whole>(m.blocks, m.own, m.halo, m.copies.sums, m.projected.sum);
    project_sums(m.kernel.node_operators(), m.mesh, m.own, m.projected.sum, m.nodes.sum);
  } else {
    assemble<Whole>(m.blocks, m.own, m.halo, m.copies.sums, m.nodes.sum);
  }
}

/// Local damping, by what particles feel of the net acceleration: all of it but where operators stand between nodes and values.
template <int D, Kernel<D> K>
void damp_towards_rest(Model<D, K>& m)
{
  find_net_acceleration(m.nodes);
  if constexpr (HasNodeOperators<K, D>) {
    m.copies.felt.send(m.nodes.felt, Numbers{});
    filter_acceleration(
        m.kernel.node_operators(), m.own, [&] { m.copies.felt.take(m.nodes.felt, Numbers{}); }, m.projected, m.nodes.felt);
  }
  if (m.stage.damping > 0)
    damp(m.stage.damping, m.nodes);
}

/// Motion of the nodes -> what particles read: the same, or hats, on which walls act once more where their values mix those of nodes.
template <int D, Kernel<D> K>
void project_to_particles([[maybe_unused]] Model<D, K>& m, [[maybe_unused]] const Kick& kick)
{
  if constexpr (HasNodeOperators<K, D>) {
    project_motion(
        m.kernel.node_operators(), m.nodes.motion, [&] { m.copies.motion.take(m.nodes.motion, Whole{}); }, m.projected);
    m.walls.apply(kick, m.projected.sum, m.projected.motion, m.sums.beyond_nodes);
  }
}

/// MUSL: momentum of the new particle velocities on the nodes, held by the walls; then L_p from these velocities, while the
/// particles move with those of the step itself.
template <int D, Kernel<D> K, class Then>
void remap(Model<D, K>& m, Real mid, Real dt, Then&& then)
{
  if constexpr (HasNodeOperators<K, D>) {
    assemble<MomentumAlone>(m.blocks, m.own, m.halo, m.copies.sums, m.projected.sum);
    project_momentum(m.kernel.node_operators(), m.mesh, m.own, m.projected.sum, m.nodes.sum);
  } else {
    assemble<MomentumAlone>(m.blocks, m.own, m.halo, m.copies.sums, m.nodes.sum);
  }
  m.small_mass_nodes.lump_momentum(m.mesh, m.own, m.nodes);
  parallel_for(static_cast<Index>(m.remapped.size()), [&](Index n) {
    const auto i = static_cast<std::size_t>(n);
    const Vec<D> v = m.nodes.active[i] ? Vec<D>(m.nodes.sum[i].momentum / m.nodes.sum[i].mass) : Vec<D>(Vec<D>::Zero());
    m.remapped[i] = {v, m.nodes.motion[i].v};
  });
  m.walls.hold(mid, m.remapped);
  m.small_mass_nodes.extrapolate_velocity(m.mesh, m.own, m.walls, mid, m.remapped);
  m.copies.motion.send(m.remapped, Whole{});
  add_ranges(std::span<const IndexRange>(m.own.of_block), m.sums.remap, [&](Index n) { return remap_work(m.nodes, m.remapped, n); });
  const auto arrive = [&] { m.copies.motion.take(m.remapped, Whole{}); };
  if constexpr (HasNodeOperators<K, D>) {
    project_gradient(m.kernel.node_operators(), m.remapped, arrive, m.projected);
    gather_gradient(
        m, m.projected.motion, [] {}, dt, then);
  } else {
    gather_gradient(m, m.remapped, arrive, dt, then);
  }
}

/// Stress of the particles of a body in a block, unless their law must know those of other blocks first.
template <int D, Kernel<D> K>
void update_stress_block(Model<D, K>& m, Index body, Index block, Real dt)
{
  AnyBatch& material = m.materials[static_cast<std::size_t>(body)];
  if (const auto rows = m.order.rows(body, block); !rows.empty() && !averages_volume(material))
    m.stress_sums[m.order.key(body, block)] = update_stress(m.mesh, material, rows, dt, m.stage.elastic, m.averaged,
                                                            pore_water(m, body, m.clock.time + dt), m.particles, m.health);
}

/// Whether the body averages its volume ratio with bodies before it, or else, into `bodies`, with which of those that follow.
template <int D, Kernel<D> K>
bool averages_with_earlier(const Model<D, K>& m, Index body, std::vector<Index>& bodies)
{
  const auto group = [&](Index b) { return averages_with(m.materials[static_cast<std::size_t>(b)]); };
  bodies.assign(1, body);
  if (group(body) == none)
    return false;
  for (Index other = 0; other < body; ++other)
    if (group(other) == group(body))
      return true;
  for (Index other = body + 1; other < m.n_bodies(); ++other)
    if (group(other) == group(body))
      bodies.push_back(other);
  return false;
}

/// What is of a body as a whole: volumes averaged before the stress, heat after it; and what the particles report.
template <int D, Kernel<D> K>
void update_stress_bodies(Model<D, K>& m, Real dt)
{
  for (Index body = 0; body < m.n_bodies(); ++body) {
    AnyBatch& material = m.materials[static_cast<std::size_t>(body)];
    if (averages_volume(material)) {
      if (!averages_with_earlier(m, body, m.averaged_bodies))
        average_volume(m.mesh, m.order, m.averaged_bodies, dt, m.particles, *m.stars, m.averaged);
      parallel_for_uneven(m.order.blocks, [&](Index block) {
        m.stress_sums[m.order.key(body, block)] = update_stress(m.mesh, material, m.order.rows(body, block), dt, m.stage.elastic,
                                                                m.averaged, pore_water(m, body, m.clock.time + dt), m.particles, m.health);
      });
    }
    if (m.heat)
      conduct_heat(m.mesh, material, m.order, body, dt, m.particles, *m.heat);
  }
  StressSums most;
  for (const StressSums& sums : m.stress_sums) {
    m.sums.internal.add(sums.work);
    most.take_extremes(sums);
  }
  m.crossing = most.crossing;
  m.watched.speed = most.speed;
  m.timings.stress += most.seconds / threads();
  m.timings.gather -= most.seconds / threads();
}

/// Before anything is changed that could not be undone.
template <int D, Kernel<D> K>
bool particles_valid(Model<D, K>& m)
{
  m.health.take(m.ranks->min(m.health.word()));
  if (!m.health.worst())
    return true;
  m.ranks->sum(m.sums.departed);
  book(m.sums.departed.value(), m.mass, m.energy);
  return false;
}

/// Work and balance of the own nodes, once all that moves them has spoken.
template <int D, Kernel<D> K>
void count(Model<D, K>& m)
{
  add_ranges(std::span<const IndexRange>(m.own.of_block), m.sums.nodes,
             [&](Index n) { return node_work(m.stage.damping, m.mesh, m.nodes, n); });
  add_ranges(std::span<const IndexRange>(m.own.of_block), m.sums.balance,
             [&](Index n) { return balance_at(m.stage.seeks_rest, m.nodes, n); });
}

/// The sums of the step, of all ranks, into the ledgers; the length of the next one and the state of health.
template <int D, Kernel<D> K>
void update_balances(Model<D, K>& m)
{
  const Vec<D>& gravity = m.nodes.gravity;
  const Real kick = m.nodes.kick;
  StepSums<D>& t = m.sums;
  t.particles.add(static_cast<Real>(m.particles.size()));
  m.ranks->sum(t.digits, t.departed, t.on_particles, t.on_mesh, t.at_nodes, t.beyond_nodes, t.nodes, t.balance, t.work_on_mesh,
               t.work_on_particles, t.internal, t.remap, t.particles, m.walls.pushed());
  m.walls.keep_impulses();
  std::array<Real, 3> extremes{m.crossing, -m.watched.speed, -t.largest_set_back};
  std::int64_t health = m.health.word();
  m.ranks->least(extremes, health);
  m.health.take(health);

  book(t.departed.value(), m.mass, m.energy);
  const NodeWork<D> work = t.nodes.value();
  const BoundaryWork walls = t.at_nodes.value(), beyond = t.beyond_nodes.value();
  const ForceAndMoment<D> tractions = t.on_particles.value() + t.on_mesh.value();
  m.mass.on_nodes = work.mass;
  m.mass.largest_set_back = std::max(m.mass.largest_set_back, -extremes[2]);
  m.momentum.loads += ForceAndMoment<D>::of(kick * work.mass * gravity, kick * moment<D>(work.first_moment, gravity)) + kick * tractions;
  m.momentum.damping += work.damped;
  m.momentum.on_nodes += work.turned + beyond.turned;
  m.energy.gravity += work.gravity;
  m.energy.damping += work.damping;
  m.energy.walls += walls.moved + beyond.moved;
  m.energy.arrival += walls.arrival + beyond.arrival;
  m.energy.friction += walls.friction + beyond.friction;
  m.energy.waves += walls.waves;
  m.energy.nodes += work.kinetic_after - work.kinetic_before - walls.arrival + beyond.friction + beyond.moved;
  m.energy.remap += t.remap.value();
  m.energy.loads += t.work_on_mesh.value() + t.work_on_particles.value();
  m.energy.internal += t.internal.value();
  m.energy.internal_ahead = t.internal.value() / 2;
  m.energy.loads_ahead = t.work_on_particles.value() / 2;
  m.timings.particle_steps += t.particles.value();
  m.residual = unbalanced(t.balance.value(), tractions.size);
  m.crossing = extremes[0];
  m.watched.speed = -extremes[1];
}

}  // namespace talus
