#include "solver/advance.hpp"

#include "core/stop_watch.hpp"
#include "solver/state/integrate.hpp"
#include "solver/stress/average_volume.hpp"

namespace talus {

namespace {

/// Updates cells, ranks and order of the particles.
template <int D>
void locate_particles(Model<D>& m)
{
  Problem<D>& problem = m.problem;
  State<D>& state = m.state;
  Workspace<D>& work = m.work;
  if (work.strips)
    return work.strips->take_exits(problem.mesh, problem.locator, problem.exits, state.materials, work.sums, work.errors);
  bool changed = relocate(problem.mesh, problem.locator, problem.exits, state.bodies, state.materials, state.particles, work.order,
                          work.sums, work.errors);
  changed |= work.migration(problem.subdomain, state.bodies, state.materials, state.particles, work.order);
  changed |= sort_by_cell(state.bodies, state.materials, state.particles, work.order);
  if (changed)
    update_tracked_rows(m);
}

/// Whether all ranks continue; checked before the step makes changes that could not be undone.
template <int D>
bool particles_valid(Model<D>& m)
{
  m.work.errors.take(m.problem.ranks->min(m.work.errors.word()));
  if (!m.work.errors.worst())
    return true;
  if (m.work.strips) {  // columns do not hold the new cells that were found
    end_sweeps(m);
    m.work.sums.clear();
    locate_particles(m);
    m.work.errors.take(m.problem.ranks->min(m.work.errors.word()));
  }
  m.problem.ranks->sum(m.work.sums.removed);
  record_removed(m.work.sums.removed.value(), m.state.mass, m.state.energy);
  return false;
}

/// Takes particles in strips to their new cells and ranks.
template <int D>
void send_leavers(Model<D>& m)
{
  if (m.work.strips)
    m.work.strips->send_leavers(m.problem.subdomain, m.work.migration);
}

/// Computes forces on single particles.
template <int D>
void apply_particle_loads(Model<D>& m)
{
  const Real time = m.state.clock.time;
  apply(m.problem.loads, time, m.state.stage.ramp(time), m.work.followed, m.work.order, m.state.particles, m.work.sums.on_particles);
}

/// Adds tractions on facets of the mesh.
template <int D>
void apply_nodal_loads(Model<D>& m)
{
  const Real time = m.state.clock.time;
  apply(m.problem.loads, time, m.state.stage.ramp(time), m.problem.mesh, m.problem.own, std::span(m.work.nodes.sum), m.work.sums.on_mesh);
}

/// Integrates v <- v + (lag + dt/2) (f/m + g).
template <int D>
void integrate_momentum(Model<D>& m, Real dt)
{
  const Clock& clock = m.state.clock;
  integrate(m.problem.loads.gravity(clock.time, m.state.stage.ramp(clock.time)), clock.lag + dt / 2, m.work.nodes);
}

/// Applies dashpots, then prescribed velocities, planes and friction.
template <int D>
void apply_boundary_conditions(Model<D>& m, const Kick& kick, Real dt)
{
  m.state.boundary.apply_dashpots(kick.to, dt, *m.problem.ranks, m.work.nodes);
  m.state.boundary.apply(kick, m.work.nodes, m.work.sums.at_nodes);
}

/// Applies local damping in stages that seek equilibrium, from the net acceleration that acts on particles.
template <int D>
void apply_local_damping(Model<D>& m)
{
  if (!m.state.stage.seeks_rest)
    return;
  find_net_acceleration(m.work.nodes);
  m.transfer->filter_acceleration(m);
  if (m.state.stage.damping > 0)
    damp(m.state.stage.damping, m.work.nodes);
}

/// Moves nodes of small mass with their hosts; then the motion of all nodes is known.
template <int D>
void extrapolate_to_small_masses(Model<D>& m, const Kick& kick)
{
  m.work.small_mass_nodes.extrapolate(m.problem.mesh, m.problem.own, kick, m.state.boundary, m.work.nodes.motion, m.work.sums.beyond_nodes);
  m.transfer->send_motion(m);
}

/// Adds up energy, impulses and balance of forces of the own nodes.
template <int D>
void record_node_sums(Model<D>& m)
{
  Problem<D>& problem = m.problem;
  State<D>& state = m.state;
  Workspace<D>& work = m.work;
  const std::span<const IndexRange> blocks = work.nodes.in_use.own();
  const Real time = state.clock.time;
  add_ranges(blocks, work.sums.nodes, [&](Index n) { return node_work(state.stage.damping, problem.mesh, work.nodes, n); });
  add_ranges(blocks, work.sums.balance, [&](Index n) { return balance_at(state.stage.seeks_rest, work.nodes, n); });
  add_work(problem.loads, time, state.stage.ramp(time), problem.own, work.nodes, work.sums.work_on_mesh);
}

/// Updates the stress of the particles of a body in a block.
template <int D>
void update_stress_block(Model<D>& m, Index body, Index block, Real dt)
{
  const Mesh<D>& mesh = m.problem.mesh;
  Particles<D>& particles = m.state.particles;
  Workspace<D>& work = m.work;
  const auto rows = work.order.rows(body, block);
  const auto water = pore_water(m, body, m.state.clock.time + dt);
  if (water)
    for (const Index row : rows) {
      const auto p = static_cast<std::size_t>(row);
      work.pore_after[p] = water->pressure(mesh, particles.cell[p], particles.x[p]);
    }
  work.stress_sums[work.order.key(body, block)] =
      update_stress(m.state.materials[static_cast<std::size_t>(body)],
                    StressBlock<D>{.rows = rows,
                                   .dt = dt,
                                   .elastic = m.state.stage.elastic,
                                   .altitudes = mesh.altitudes(),
                                   .averaged = work.averaged,
                                   .pore_after = water ? std::span<const Real>(work.pore_after) : std::span<const Real>(),
                                   .particles = particles,
                                   .errors = work.errors});
}

/// Updates the stress as above, unless the law needs data of other blocks first.
template <int D>
void update_stress_while_cached(Model<D>& m, Index body, Index block, Real dt)
{
  if (!m.work.order.rows(body, block).empty() && !m.state.materials[static_cast<std::size_t>(body)].averages_volume)
    update_stress_block(m, body, block, dt);
}

/// Whether the volume ratios of the body have already been averaged together with bodies before it; otherwise sets `bodies` to it and those
/// after it with which they are averaged.
template <int D>
bool averages_with_earlier(const Model<D>& m, Index body, std::vector<Index>& bodies)
{
  const auto group = [&](Index b) { return averages_with(m.state.materials[static_cast<std::size_t>(b)]); };
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

/// Updates that need a whole body: averaged volumes before the stress, heat after it; then collects the extremes that particles report.
template <int D>
void update_stress_bodies(Model<D>& m, Real dt)
{
  Problem<D>& problem = m.problem;
  State<D>& state = m.state;
  Workspace<D>& work = m.work;
  for (Index body = 0; body < m.n_bodies(); ++body) {
    Material& material = state.materials[static_cast<std::size_t>(body)];
    if (material.averages_volume) {
      if (!averages_with_earlier(m, body, work.averaged_bodies))
        average_volume(problem.mesh, work.order, work.averaged_bodies, dt, state.particles, *work.patch_sums, work.averaged);
      parallel_for_uneven(work.order.blocks, [&](Index block) { update_stress_block(m, body, block, dt); });
    }
    if (work.heat)
      conduct_heat(problem.mesh, material, work.order, body, dt, state.particles, *work.heat);
  }
  StressSums most;
  for (const StressSums& sums : work.stress_sums) {
    work.sums.internal.add(sums.work);
    most.take_extremes(sums);
  }
  state.crossing = most.crossing;
  state.monitor.speed = most.speed;
  state.timings.stress += most.seconds / threads();
  state.timings.gather -= most.seconds / threads();
}

/// Adds the sums of the step over all ranks to the balances; sets the extremes that bound the next step, and the errors of particles.
template <int D>
void update_balances(Model<D>& m)
{
  Problem<D>& problem = m.problem;
  State<D>& state = m.state;
  Workspace<D>& work = m.work;
  StepSums<D>& sums = work.sums;
  add_work(work.order, state.particles, sums.work_on_particles);
  sums.particles.add(static_cast<Real>(n_particles(m)));
  problem.ranks->sum(sums.digits, sums.removed, sums.on_particles, sums.on_mesh, sums.at_nodes, sums.beyond_nodes, sums.nodes, sums.balance,
                     sums.work_on_mesh, sums.work_on_particles, sums.internal, sums.remap, sums.particles, state.boundary.pushed());
  state.boundary.keep_impulses();
  std::array<Real, 3> extremes{state.crossing, -state.monitor.speed, -sums.largest_set_back};
  std::int64_t errors = work.errors.word();
  problem.ranks->least(extremes, errors);
  work.errors.take(errors);
  state.crossing = extremes[0];
  state.monitor.speed = -extremes[1];
  state.mass.largest_set_back = std::max(state.mass.largest_set_back, -extremes[2]);
  add_step(sums, work.nodes.gravity, work.nodes.kick, state.mass, state.momentum, state.energy);
  state.timings.particle_steps += sums.particles.value();
  state.residual = unbalanced(sums.balance.value(), (sums.on_particles.value() + sums.on_mesh.value()).size);
}

}  // namespace

template <int D>
void advance(Model<D>& m, Real dt)
{
  make_step(m, dt);
  end_sweeps(m);
}

// The numbers are those of the rows in docs/theory/algorithm.md.  Where particles are in strips, the transfer to them (9 to 12) does 3 for
// the next step too.
template <int D>
void make_step(Model<D>& m, Real dt)
{
  drop_copy(m);
  if (may_sweep(m))
    begin_sweeps(m);
  Problem<D>& problem = m.problem;
  State<D>& state = m.state;
  Workspace<D>& work = m.work;
  Transfer<D>& transfer = *m.transfer;
  const Kick kick{state.clock.time - state.clock.lag, state.clock.time + dt / 2};
  StopWatch watch;

  work.sums.clear();
  locate_particles(m);  //  1
  if (!particles_valid(m))
    return;
  send_leavers(m);
  apply_particle_loads(m);  //  2
  watch.lap(state.timings.locate);
  transfer.particles_to_nodes(m);  //  3
  watch.lap(state.timings.scatter);
  transfer.assemble_nodes(m);  //  4
  apply_nodal_loads(m);
  work.small_mass_nodes.lump(problem.mesh, problem.own, work.nodes);  //  5
  integrate_momentum(m, dt);                                          //  6
  apply_boundary_conditions(m, kick, dt);                             //  7
  apply_local_damping(m);
  extrapolate_to_small_masses(m, kick);  //  8
  record_node_sums(m);
  watch.lap(state.timings.nodes);
  work.stress_sums.assign(work.order.first.size(), {});
  transfer.nodes_to_particles(m, kick, dt,
                              [&m, dt](Index body, Index block) { update_stress_while_cached(m, body, block, dt); });  //  9 to 12
  update_stress_bodies(m, dt);                                                                                         // 12
  update_balances(m);
  watch.lap(state.timings.gather);  // update_stress_bodies() measures the time of the stress update itself
  state.clock = {.step = state.clock.step + 1, .time = state.clock.time + dt, .dt = dt, .lag = dt / 2};
}

template void make_step(Model<2>&, Real);
template void make_step(Model<3>&, Real);
template void advance(Model<2>&, Real);
template void advance(Model<3>&, Real);

}  // namespace talus
