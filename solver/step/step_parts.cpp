#include "solver/step/step_parts.hpp"

#include "solver/state/integrate.hpp"

namespace talus {

namespace {

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

}  // namespace

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

template <int D>
void unite_sides_of_sheets(Model<D>& m)
{
  m.work.sheets.find(m.problem.mesh, m.problem.rigid, m.state.rigid);
  m.work.sheets.unite(m.problem.mesh, m.problem.own, m.work.fields);
}

template <int D>
void apply_nodal_loads(Model<D>& m)
{
  const Real time = m.state.clock.time;
  for (VelocityField<D>& field : m.work.fields)
    apply(m.problem.loads, time, m.state.stage.ramp(time), m.problem.mesh, m.problem.own, std::span(field.nodes.sum), m.work.sums.on_mesh);
}

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
void stop_particles(Model<D>& m)
{
  Particles<D>& particles = m.state.particles;
  particles.v.assign(particles.v.size(), Vec<D>::Zero());
  for (auto* affine : {&particles.L, &particles.C})
    affine->assign(affine->size(), Mat<D>::Zero());
}

template <int D>
void clear_particle_sums(Model<D>& m)
{
  m.work.stress_sums.assign(m.work.strips->keys(), {});
  m.work.load_sums.assign(m.work.strips->layout().step_arrays().applied != none ? m.work.strips->keys() : 0, {});
}

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

template <int D>
void update_balances(Model<D>& m)
{
  Problem<D>& problem = m.problem;
  State<D>& state = m.state;
  Workspace<D>& work = m.work;
  StepSums<D>& sums = work.sums;
  problem.ranks->sum(sums.digits, sums.removed, sums.on_particles, sums.on_mesh, sums.at_nodes, sums.beyond_nodes, sums.nodes, sums.balance,
                     sums.work_on_mesh, sums.work_on_particles, sums.internal, sums.stress_at_nodes, sums.remap, sums.particles,
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

#define TALUS_INSTANTIATE(D)                            \
  template bool locate_particles(Model<D>&);            \
  template void unite_sides_of_sheets(Model<D>&);       \
  template void apply_nodal_loads(Model<D>&);           \
  template void find_renewed_bodies(Model<D>&);         \
  template BetweenParts between_parts(Model<D>&, Real); \
  template void stop_particles(Model<D>&);              \
  template void clear_particle_sums(Model<D>&);         \
  template void record_particle_sums(Model<D>&);        \
  template void update_balances(Model<D>&);

TALUS_INSTANTIATE(2)
TALUS_INSTANTIATE(3)
#undef TALUS_INSTANTIATE

}  // namespace talus
