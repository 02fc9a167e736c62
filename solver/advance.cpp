#include "solver/advance.hpp"

#include "core/stop_watch.hpp"
#include "solver/model/seepage.hpp"
#include "solver/rigid/rigid_contacts.hpp"
#include "solver/state/integrate.hpp"
#include "solver/step/step_parts.hpp"

namespace talus {

namespace {

/// Finds the forces of the stress against jumps of gradients, which stages without inertia leave, of the particles as the step before has
/// left them.
template <int D>
void find_jump_forces(Model<D>& m)
{
  if (m.work.jump_stress)
    m.work.jump_stress->find(m.problem.mesh, m.problem.subdomain, *m.work.strips, m.state.empty_cells);
}

/// Adds them to those of the own nodes.
template <int D>
void add_jump_forces(Model<D>& m)
{
  if (!m.work.jump_stress)
    return;
  Nodes<D>& nodes = m.work.fields.front().nodes;
  nodes.in_use.for_each([&](Index n) {
    if (m.problem.own.has(n))
      nodes.sum[to_size(n)].force += m.work.jump_stress->forces()[to_size(n)];
  });
}

/// Counts their work as that of stress: by remapped velocities, where strains follow from these.  The remap knows the forces at nodes with a
/// motion of their own.
template <int D>
void record_jump_work(Model<D>& m)
{
  if (!m.work.jump_stress)
    return;
  VelocityField<D>& field = m.work.fields.front();
  const Nodes<D>& nodes = field.nodes;
  const std::vector<Vec<D>>& forces = m.work.jump_stress->forces();
  std::vector<Vec<D>> given = forces;
  field.small_mass_nodes.give(
      m.problem.own, [](Index, const Vec<D>& force) { return force; }, given);
  const bool is_remapped = m.problem.transfer.uses_musl();
  add_ranges(nodes.in_use.own(), m.work.sums.stress_at_nodes, [&](Index n) {
    return work_over_step(nodes, n, forces[to_size(n)]) - (is_remapped ? remap_work(nodes, n, given[to_size(n)]) : 0);
  });
}

/// Gives mass, momentum and force of nodes of small mass to their hosts.
template <int D>
void lump_small_masses(Model<D>& m)
{
  for (VelocityField<D>& field : m.work.fields)
    field.small_mass_nodes.lump(m.problem.mesh, m.problem.own, field.nodes);
}

/// Unites nodes of cuts with their twins while these are tied.
template <int D>
void tie_cuts(Model<D>& m, Real dt)
{
  m.work.cuts.tie(m.state.clock.time, m.state.clock.lag + dt / 2, m.problem.own, m.work.fields.front().nodes);
}

/// Integrates v <- v + (lag + dt/2) (f/m + g).
template <int D>
void integrate_momentum(Model<D>& m, Real dt)
{
  const Clock& clock = m.state.clock;
  for (VelocityField<D>& field : m.work.fields)
    integrate(m.problem.loads.gravity(clock.time, m.state.stage.ramp(clock.time)), clock.lag + dt / 2, field.nodes);
}

/// Applies dashpots, then prescribed velocities, planes and friction; walls with gaps where material touches them.
template <int D>
void apply_boundary_conditions(Model<D>& m, const Kick& kick, Real dt)
{
  m.work.walls.find(m.problem.mesh, *m.work.strips, m.work.fields);
  for (VelocityField<D>& field : m.work.fields) {
    m.state.boundary.apply_dashpots(kick.to, dt, *m.problem.ranks, field.nodes);
    m.state.boundary.apply(kick, field.nodes, m.work.sums.at_nodes);
  }
}

/// Exchanges impulses where bodies with velocity fields of their own touch, and between the sides of cuts.
template <int D>
void apply_contacts(Model<D>& m, const Kick& kick)
{
  m.work.contact.find(m.problem.mesh, m.problem.own, *m.work.strips, m.work.fields);
  m.work.contact.act(kick, m.state.boundary, m.work.fields, m.work.sums.at_nodes);
  m.work.cuts.act(m.problem.mesh, kick, m.problem.own, *m.work.strips, m.state.boundary, m.work.fields.front().nodes, m.work.sums.at_nodes);
}

/// Exchanges impulses of rigid bodies with material, then with each other and with walls.
template <int D>
void apply_rigid_bodies(Model<D>& m, const Kick& kick, Real dt)
{
  const RigidScene<D>& scene = m.problem.rigid;
  if (scene.bodies.empty())
    return;
  State<D>& state = m.state;
  const std::vector<RigidState<D>> before = state.rigid;
  begin_step(scene, m.problem.loads.gravity(state.clock.time, state.stage.ramp(state.clock.time)), kick.length(), kick.to, state.rigid);
  RigidNodes<D>& nodes = m.work.rigid;
  nodes.find(m.problem.mesh, m.problem.own, *m.work.strips, scene, state.rigid, m.work.sheets, m.work.fields,
             rigid_bodies_use_affine_fields(m));
  nodes.act(kick, *m.problem.ranks, scene, state.boundary, state.rigid, m.work.fields, m.work.sums.at_nodes);
  std::vector<RigidContact<D>> contacts = find_contacts<D>(scene, state.rigid, dt);
  act_on_contacts<D>(scene, dt, contacts, state.rigid);
  if (state.stage.damping > 0)
    damp<D>(scene, state.stage.damping, before, state.rigid);
}

/// Applies local damping in stages that seek equilibrium, from the net acceleration that acts on particles.
template <int D>
void apply_local_damping(Model<D>& m)
{
  if (!m.state.stage.seeks_rest)
    return;
  for (VelocityField<D>& field : m.work.fields)
    find_net_acceleration(field.nodes);
  m.work.sheets.copy_to_field_behind(
      std::span(m.work.fields), [](Nodes<D> & nodes) -> auto& { return nodes.felt; });
  m.transfer->filter_acceleration(m);
  if (m.state.stage.damping > 0)
    for (VelocityField<D>& field : m.work.fields)
      damp(m.state.stage.damping, field.nodes);
}

/// Moves nodes of small mass with their hosts.
template <int D>
void extrapolate_to_small_masses(Model<D>& m, const Kick& kick)
{
  for (VelocityField<D>& field : m.work.fields)
    field.small_mass_nodes.extrapolate(m.problem.own, kick, m.state.boundary, field.nodes, m.work.sums.beyond_nodes);
}

/// Finds the pressure of flowing pore water at the end of the step, and what it does to velocities.
template <int D>
void find_pore_pressures(Model<D>& m, const Kick& kick, Real dt)
{
  State<D>& state = m.state;
  if (!state.stage.flows)
    return;
  const Real end = state.clock.time + dt;
  const FlowStep<D> step{.end = end,
                         .dt = dt,
                         .kick = kick.length(),
                         .weight = weight_of_water(m.problem, state.stage, end),
                         .forces = forces_on_water(m.problem, state.stage, end)};
  const FlowModel<D> model{m.problem.mesh, m.problem.flow, m.problem.own, *m.problem.ranks, state.boundary, m.work.fields.front()};
  m.work.flow->advance(model, state.materials, *m.work.strips, step, state.flow, m.work.sums.stress_at_nodes);
}

/// Tells particles and other ranks how nodes move.
template <int D>
void send_motion(Model<D>& m)
{
  m.work.sheets.copy_to_field_behind(
      std::span(m.work.fields), [](Nodes<D> & nodes) -> auto& { return nodes.motion; });
  m.transfer->send_motion(m);
}

/// Adds up energy, impulses and balance of forces of the own nodes.
template <int D>
void record_node_sums(Model<D>& m)
{
  Problem<D>& problem = m.problem;
  State<D>& state = m.state;
  Workspace<D>& work = m.work;
  const Real time = state.clock.time;
  for (const VelocityField<D>& field : work.fields) {
    const Nodes<D>& nodes = field.nodes;
    const std::span<const IndexRange> blocks = nodes.in_use.own();
    add_ranges(blocks, work.sums.nodes, [&](Index n) { return node_work(state.stage.damping, problem.mesh, nodes, n); });
    add_ranges(blocks, work.sums.balance, [&](Index n) { return balance_at(state.stage.seeks_rest, nodes, n); });
    add_work(problem.loads, time, state.stage.ramp(time), problem.own, nodes, work.sums.work_on_mesh);
    if (!problem.loads.on_surfaces.empty())
      add_ranges(blocks, work.sums.work_on_mesh, [&](Index n) { return surface_work(nodes, n); });
  }
  work.contact.add_sums(problem.mesh, work.fields, work.sums.contacts);
  work.cuts.add_sums(problem.mesh, problem.own, work.fields.front().nodes, std::span(work.sums.contacts).last(problem.cuts.size()));
  work.rigid.add_sums(problem.mesh, state.rigid, work.fields, work.sums.rigid);
}

}  // namespace

template <int D>
void advance(Model<D>& m, Real dt)
{
  make_step(m, dt);
  end_sweeps(m);
}

// The numbers are those of the rows in docs/theory/algorithm.md.  The sums of the particles (2 and 3) were made at the end of the step before;
// particles that have changed their block are missing.
template <int D>
void make_step(Model<D>& m, Real dt)
{
  drop_copy(m);
  begin_sweeps(m);
  Problem<D>& problem = m.problem;
  State<D>& state = m.state;
  Workspace<D>& work = m.work;
  Transfer<D>& transfer = *m.transfer;
  const Kick kick{state.clock.time - state.clock.lag, state.clock.time + dt / 2};
  StopWatch watch;

  work.sums.clear();
  find_jump_forces(m);
  if (!locate_particles(m))  //  1
    return;
  work.strips->send_leavers(problem.subdomain, work.migration);
  watch.lap(state.timings.locate);
  transfer.particles_to_nodes(m);  //  3
  watch.lap(state.timings.scatter);
  transfer.assemble_nodes(m);  //  4
  unite_sides_of_sheets(m);
  apply_nodal_loads(m);
  add_jump_forces(m);
  lump_small_masses(m);  //  5
  transfer.add_affine_momentum(m, kick.from);
  tie_cuts(m, dt);
  integrate_momentum(m, dt);               //  6
  apply_boundary_conditions(m, kick, dt);  //  7
  apply_contacts(m, kick);
  apply_rigid_bodies(m, kick, dt);
  apply_local_damping(m);
  extrapolate_to_small_masses(m, kick);  //  8
  find_pore_pressures(m, kick, dt);
  send_motion(m);
  record_node_sums(m);
  watch.lap(state.timings.nodes);
  clear_particle_sums(m);
  find_renewed_bodies(m);
  transfer.nodes_to_particles(m, kick, dt, between_parts(m, dt));  //  9 to 12, and 2 and 3 of the next step
  record_jump_work(m);
  record_particle_sums(m);
  move(problem.rigid, dt, state.rigid);
  update_balances(m);
  watch.lap(state.timings.gather);  // without the stress, whose time particles measure
  state.clock = {.step = state.clock.step + 1, .time = state.clock.time + dt, .dt = dt, .lag = dt / 2};
}

template void make_step(Model<2>&, Real);
template void make_step(Model<3>&, Real);
template void advance(Model<2>&, Real);
template void advance(Model<3>&, Real);

}  // namespace talus
