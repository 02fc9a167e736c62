#include "solver/advance.hpp"

#include "core/stop_watch.hpp"
#include "solver/model/seepage.hpp"
#include "solver/rigid/rigid_contacts.hpp"
#include "solver/state/integrate.hpp"

namespace talus {

namespace {

/// Whether the step can begin on all ranks: every particle has a cell, or a reason to be removed.  Otherwise the particles are in their
/// columns, as they were.
template <int D>
bool locate_particles(Model<D>& m)
{
  Workspace<D>& work = m.work;
  const auto set_forces = [&m](const StripColumns<D>& one) { find_forces(m, m.state.clock.time, one, 1); };
  work.strips->take_exits(m.problem.mesh, m.problem.locator, m.problem.exits, m.state.materials, set_forces, work.sums, work.errors);
  work.errors.take(m.problem.ranks->min(work.errors.word()));
  if (!work.errors.worst())
    return true;
  end_sweeps(m);
  work.sums.clear();
  return false;
}

/// Adds tractions on facets of the mesh.
template <int D>
void apply_nodal_loads(Model<D>& m)
{
  const Real time = m.state.clock.time;
  for (VelocityField<D>& field : m.work.fields)
    apply(m.problem.loads, time, m.state.stage.ramp(time), m.problem.mesh, m.problem.own, std::span(field.nodes.sum), m.work.sums.on_mesh);
}

/// Unites the fields on both sides of sheets at nodes that no sheet parts.
template <int D>
void unite_sides_of_sheets(Model<D>& m)
{
  m.work.sheets.find(m.problem.mesh, m.problem.rigid, m.state.rigid);
  m.work.sheets.unite(m.problem.mesh, m.problem.own, m.work.fields);
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
  nodes.find(m.problem.mesh, m.problem.own, *m.work.strips, scene, state.rigid, m.work.sheets, m.work.fields);
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
    field.small_mass_nodes.extrapolate(m.problem.mesh, m.problem.own, kick, m.state.boundary, field.nodes, m.work.sums.beyond_nodes);
}

/// Finds the pressure of flowing pore water at the end of the step, and what it does to velocities.
template <int D>
void find_pore_pressures(Model<D>& m, const Kick& kick, Real dt)
{
  State<D>& state = m.state;
  if (!state.stage.flows)
    return;
  const Real end = state.clock.time + dt;
  const FlowStep<D> step{.end = end, .dt = dt, .kick = kick.length(), .weight = weight_of_water(m.problem, state.stage, end)};
  const FlowModel<D> model{m.problem.mesh, m.problem.flow, m.problem.own, *m.problem.ranks, state.boundary, m.work.fields.front()};
  m.work.flow->advance(model, state.materials, *m.work.strips, step, state.flow, m.work.sums.pore);
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

/// Finds the bodies that take a new reference at the end of the step, by what their particles were at its beginning.  Bodies of one velocity
/// field do so together.
template <int D>
void find_renewed_bodies(Model<D>& m)
{
  if (!m.problem.columns.reference)
    return;
  std::vector<Real> least(m.problem.fields_in_front(), 0);  // of each field; -1 where a body is due
  for (std::size_t key = 0; key < m.work.due.size(); ++key)
    if (m.work.due[key] != 0)
      least[m.problem.field_of(m.work.strips->body(key), false)] = -1;
  std::int64_t no_word = 0;
  m.problem.ranks->least(least, no_word);
  m.work.renewed.clear();
  for (Index body = 0; body < m.n_bodies(); ++body)
    m.work.renewed.push_back(m.problem.references[to_size(body)].is_renewed(least[m.problem.field_of(body, false)] < 0) ? 1 : 0);
  m.work.due.assign(m.work.strips->keys(), 0);
}

/// Conducts heat within each body whose law has temperature, not through sheets.
template <int D>
void conduct_heat(Model<D>& m, Real dt)
{
  const ParticleStrips<D>& strips = *m.work.strips;
  for (Index group = 0; group < strips.groups(); ++group)
    conduct_heat(m.problem.mesh, m.state.materials[static_cast<std::size_t>(strips.body_of(group))].law(), strips, group, dt, *m.work.heat);
}

/// Averages the plastic strain of bodies whose softening has a length.
template <int D>
void average_strains(Model<D>& m, Real dt)
{
  const ParticleStrips<D>& strips = *m.work.strips;
  for (AveragedStrain<D>& one : m.work.softening) {
    const Index body = strips.body_of(one.groups.front());
    one.advance(m.problem.mesh, m.state.materials[to_size(body)].law(), strips, dt);
  }
}

/// Averaged volumes are needed before the stress; heat is conducted and strains are averaged after it.
template <int D>
BetweenParts between_parts(Model<D>& m, Real dt)
{
  BetweenParts between;
  if (!m.work.averaged.empty()) {
    between.after_motion = [&m](Index block) {
      for (AveragedBodies<D>& one : m.work.averaged)
        one.sum_block(m.problem.mesh, *m.work.strips, block);
    };
    between.before_stress = [&m] {
      for (AveragedBodies<D>& one : m.work.averaged)
        one.sums.assemble();
    };
    between.before_stress_of_block = [&m](Index block) {
      for (const AveragedBodies<D>& one : m.work.averaged)
        one.average_block(m.problem.mesh, *m.work.strips, block);
    };
  }
  if (m.work.heat || !m.work.softening.empty())
    between.after_stress = [&m, dt] {
      if (m.work.heat)
        conduct_heat(m, dt);
      average_strains(m, dt);
    };
  return between;
}

template <int D>
void clear_particle_sums(Model<D>& m)
{
  m.work.stress_sums.assign(m.work.strips->keys(), {});
  m.work.load_sums.assign(m.work.strips->layout().step_arrays().applied != none ? m.work.strips->keys() : 0, {});
}

/// Collects what particles report of their stress and loads.
template <int D>
void record_particle_sums(Model<D>& m)
{
  State<D>& state = m.state;
  Workspace<D>& work = m.work;
  StressSums most;
  for (const StressSums& sums : work.stress_sums) {
    work.sums.internal.add(sums.work);
    most.take_extremes(sums);
  }
  for (const ParticleLoadSums<D>& sums : work.load_sums) {
    work.sums.on_particles.add(sums.force);
    work.sums.work_on_particles.add(sums.work);
  }
  work.sums.particles.add(static_cast<Real>(n_particles(m)));
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
  problem.ranks->sum(sums.digits, sums.removed, sums.on_particles, sums.on_mesh, sums.at_nodes, sums.beyond_nodes, sums.nodes, sums.balance,
                     sums.work_on_mesh, sums.work_on_particles, sums.internal, sums.pore, sums.remap, sums.particles,
                     state.boundary.pushed(), std::span(sums.contacts), std::span(sums.rigid));
  state.boundary.keep_impulses();
  for (std::size_t law = 0; law < state.contacts.size(); ++law)
    state.contacts[law] += sums.contacts[law].value();
  for (std::size_t body = 0; body < state.rigid.size(); ++body)
    state.rigid[body].done += sums.rigid[body].value();
  std::array<Real, 3> extremes{state.crossing, -state.monitor.speed, -sums.largest_set_back};
  std::int64_t errors = work.errors.word();
  problem.ranks->least(extremes, errors);
  work.errors.take(errors);
  state.crossing = extremes[0];
  state.monitor.speed = -extremes[1];
  state.mass.largest_set_back = std::max(state.mass.largest_set_back, -extremes[2]);
  add_step(sums, work.fields.front().nodes.gravity, work.fields.front().nodes.kick, state.mass, state.momentum, state.energy);
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
  if (!locate_particles(m))  //  1
    return;
  work.strips->send_leavers(problem.subdomain, work.migration);
  watch.lap(state.timings.locate);
  transfer.particles_to_nodes(m);  //  3
  watch.lap(state.timings.scatter);
  transfer.assemble_nodes(m);  //  4
  unite_sides_of_sheets(m);
  apply_nodal_loads(m);
  lump_small_masses(m);  //  5
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
