#include "solver/model/model.hpp"

#include <algorithm>
#include <cmath>

#include "solver/particles/redistribute.hpp"

namespace talus {

template <int D>
void Model<D>::join(Communicator& others, Subdomain part)
{
  problem.ranks = &others;
  problem.subdomain = std::move(part);
  problem.own = own_nodes(problem.mesh, problem.subdomain);
  work.migration = Migration<D>(others, problem.subdomain);
  work.fields.clear();
  add_field();
  transfer->join(problem);
}

template <int D>
void Model<D>::add_field()
{
  VelocityField<D>& field = work.fields.emplace_back();
  field.nodes = Nodes<D>(problem.mesh.n_nodes());
  field.nodes.in_use.prepare(problem.mesh, problem.own);
  if (!problem.subdomain.alone())
    field.small_mass_nodes = SmallMassNodes<D>(*problem.ranks, problem.mesh, problem.subdomain, problem.own);
}

template <int D>
void fill_columns(const WantedColumns& wanted, Particles<D>& particles)
{
  const auto n = particles.id.size();
  if (wanted.affine && particles.C.empty())
    particles.C = particles.L;
  if (wanted.applied)
    particles.applied.assign(n, Vec<D>::Zero());
  if (wanted.volume_ratio && particles.volume_ratio.empty())
    particles.volume_ratio.assign(n, 1);
  if (wanted.viscous && particles.viscous.empty())
    particles.viscous.assign(n, 0);
  if (wanted.pore && particles.pore.empty())
    particles.pore.assign(n, 0);
  if (wanted.flow && particles.water.empty()) {
    particles.water = particles.pore;
    particles.water_gradient.assign(n, Vec<D>::Zero());
    particles.water_at_rest.assign(n, 0);
  }
  if (wanted.jump_stress && particles.jump_stress.empty())
    particles.jump_stress.assign(n, Mat<D>::Zero());
  if (wanted.side && particles.side.empty())
    particles.side.assign(n, 0);
  if (wanted.reference && particles.reference.empty()) {
    particles.reference = particles.x;
    particles.G.assign(n, Mat<D>::Identity());
  }
  if (wanted.domain && particles.domain.empty()) {
    const ParticleColumn<Real>& volume = particles.volume.empty() ? particles.volume0 : particles.volume;
    particles.domain.resize(n);
    for (std::size_t p = 0; p < n; ++p)
      particles.domain.set(p, std::pow(volume[p], 1.0 / D) * Mat<D>::Identity());
  }
}

template <int D>
void update_rows(Model<D>& m)
{
  sort_by_cell(m.state.particles.cell, m.state.particles.id, m.state.bodies, m.problem.mesh.n_cells(), m.work.order);
}

template <int D>
void adopt_state(Model<D>& m)
{
  if (!m.problem.subdomain.alone())
    receive_owned_particles(*m.problem.ranks, m.problem.subdomain, m.state.bodies, m.state.materials, m.state.particles);
  update_rows(m);
}

/// The groups of particles, see ParticleStrips, whose reach counts in each velocity field.  Nodes that no sheet parts have their mass in the
/// field in front, so particles behind sheets count there too.
template <int D>
std::vector<std::vector<Index>> groups_of_field(const Model<D>& m)
{
  std::vector<std::vector<Index>> groups(m.problem.n_fields());
  for (const bool behind : {false, true})
    for (Index body = 0; body < m.n_bodies() && (!behind || m.problem.rigid.any_sheet()); ++body)
      for (const bool of_field_behind : {false, true})
        if (behind || !of_field_behind)
          groups[m.problem.field_of(body, of_field_behind)].push_back(behind ? m.n_bodies() + body : body);
  return groups;
}

template <int D>
void bind_boundary_conditions(Model<D>& m)
{
  Problem<D>& problem = m.problem;
  State<D>& state = m.state;
  Workspace<D>& work = m.work;
  state.boundary.finalize();
  for (VelocityField<D>& field : work.fields) {
    field.nodes.bound.resize(field.nodes.sum.size());
    for (Index node = 0; node < problem.mesh.n_nodes(); ++node)
      field.nodes.bound[static_cast<std::size_t>(node)] = state.boundary.binds(node) ? 1 : 0;
  }
  work.walls.begin(problem.mesh, problem.subdomain, *problem.ranks, state.boundary, groups_of_field(m), work.fields);
  problem.exits.closed.assign(static_cast<std::size_t>(problem.mesh.n_cells()), 0);
  for (const Facet facet : state.boundary.closed_facets(problem.mesh))
    problem.exits.closed[static_cast<std::size_t>(facet.cell)] |= static_cast<std::uint8_t>(1 << facet.local);
}

/// Whether a stress against jumps of gradients has a meaning: jumps are those of one velocity field, and of averages.
template <int D>
bool may_have_jump_stress(const Model<D>& m)
{
  return m.transfer->averages_gradients() && m.problem.n_fields() == 1;
}

template <int D>
void make_ready(Model<D>& m, std::span<const std::vector<Material>> to_come)
{
  Problem<D>& problem = m.problem;
  State<D>& state = m.state;
  Workspace<D>& work = m.work;
  Transfer<D>& transfer = *m.transfer;
  if (state.particles.volume.empty())
    state.particles.volume = state.particles.volume0;
  const auto any_material = [&](bool (*has)(const Material&)) {
    const auto any_of = [&](const std::vector<Material>& laws) { return std::any_of(laws.begin(), laws.end(), has); };
    return any_of(state.materials) || std::any_of(to_come.begin(), to_come.end(), any_of);
  };
  const bool reference = has_reference(problem.references);
  problem.columns = {.affine = problem.transfer.own_affine_field() || (reference && problem.transfer.affine()),
                     .applied = problem.loads.any_on_particles(),
                     .volume_ratio = any_material([](const Material& material) { return material.averages_volume; }),
                     .viscous = any_material([](const Material& material) { return material.viscosity.has_value(); }),
                     .pore = problem.water.any(),
                     .flow = problem.flow.any(),
                     .jump_stress = problem.equations != nullptr && may_have_jump_stress(m),
                     .side = problem.rigid.any_sheet(),
                     .reference = reference,
                     .domain = any_resampled(problem.resampling)};
  if (!may_have_jump_stress(m)) {
    state.particles.jump_stress = {};
    state.empty_cells.clear();
  }
  fill_columns(problem.columns, state.particles);
  const bool alone = problem.subdomain.alone();
  if (any_material([](const Material& material) { return material.law().heat().has_value(); }))
    alone ? work.heat.emplace(problem.mesh) : work.heat.emplace(*problem.ranks, problem.mesh, problem.subdomain);
  if (problem.flow.any())
    alone ? work.flow.emplace(problem.mesh) : work.flow.emplace(*problem.ranks, problem.mesh, problem.subdomain, problem.own);
  while (work.fields.size() < problem.n_fields())
    m.add_field();
  transfer.prepare(problem);
  work.contact.begin(problem.mesh, problem.subdomain, *problem.ranks, problem.contacts);
  work.cuts.begin(problem.mesh, problem.subdomain, *problem.ranks, problem.cuts);
  work.sums.contacts.resize(problem.contacts.laws.size() + problem.cuts.size());
  state.contacts.resize(work.sums.contacts.size());
  work.sheets.begin(problem.mesh, problem.subdomain, *problem.ranks, problem.own, problem.rigid, problem.fields_in_front());
  work.rigid.begin(problem.mesh, problem.subdomain, *problem.ranks, problem.rigid, groups_of_field(m));
  work.sums.rigid.resize(problem.rigid.bodies.size());
  work.carriers = TrackedIds(ids_of(problem.loads.on_particles));
  bind_boundary_conditions(m);
  const LeastShares least = transfer.least_shares();
  for (VelocityField<D>& field : work.fields) {
    field.nodes.least_share_of_gross = least.of_gross;
    field.nodes.least_share = least.of_particles;
    if (problem.transfer.uses_musl())
      field.nodes.remapped.resize(field.nodes.motion.size());
  }
  update_rows(m);
  state.mass.start = totals(m).mass;
}

template <int D>
std::optional<PoreWater> pore_water(const Model<D>& m, Index body, Real time)
{
  if (!m.problem.water.drains(body))
    return std::nullopt;
  return PoreWater{m.problem.water, m.state.stage.ramp(time) * m.problem.loads.gravity.table(time)};
}

template <int D>
void find_forces(const Model<D>& m, Real time, const StripColumns<D>& columns, std::size_t n)
{
  if (columns.applied)
    find_forces(m.problem.loads, time, m.state.stage.ramp(time), m.work.carriers, columns, n);
}

namespace {

/// Puts the groups of particles into parts that are averaged as one, the same parts of `all` used again.  A group takes part if takes_part(material);
/// it is averaged with those of its velocity field that have the same with(material), unless that is `none`.
template <class Part, int D>
void find_parts(const Model<D>& m, std::vector<Part>& all, auto&& takes_part, auto&& with, auto&& make)
{
  for (Part& part : all)
    part.groups.clear();
  const ParticleStrips<D>& strips = *m.work.strips;
  const auto field = [&](Index group) { return m.problem.field_of(strips.body_of(group), strips.is_behind(group)); };
  auto end = all.begin();
  for (Index group = 0; group < strips.groups(); ++group) {
    const Material& material = m.state.materials[to_size(strips.body_of(group))];
    if (!takes_part(material))
      continue;
    const auto same = std::find_if(all.begin(), end, [&](const Part& part) {
      const Index first = part.groups.front(), number = with(material);
      return number != none && number == with(m.state.materials[to_size(strips.body_of(first))]) && field(first) == field(group);
    });
    if (same != end) {
      same->groups.push_back(group);
      continue;
    }
    if (end == all.end()) {
      all.push_back(make());
      end = all.end() - 1;
    }
    (end++)->groups.push_back(group);
  }
  all.erase(end, all.end());
}

/// Finds the groups of particles that average their volumes or their plastic strain, by those that do it as one.  Collective.
template <int D>
void find_averaged_bodies(Model<D>& m)
{
  Problem<D>& problem = m.problem;
  const bool alone = problem.subdomain.alone();
  find_parts(
      m, m.work.averaged, [](const Material& material) { return material.averages_volume; },
      [](const Material& material) { return averages_with(material); },
      [&] {
        return AveragedBodies<D>{
            {}, alone ? NodePatchSums<D, 2>(problem.mesh) : NodePatchSums<D, 2>(*problem.ranks, problem.mesh, problem.subdomain)};
      });
  find_parts(
      m, m.work.softening, [](const Material& material) { return material.law().strain_averaging().has_value(); },
      [](const Material& material) { return material.kind; },
      [&] { return alone ? AveragedStrain<D>(problem.mesh) : AveragedStrain<D>(*problem.ranks, problem.mesh, problem.subdomain); });
}

}  // namespace

template <int D>
bool rigid_bodies_use_affine_fields(const Model<D>& m)
{
  return !m.problem.rigid.bodies.empty() && m.problem.transfer.affine() && !m.problem.columns.reference;
}

template <int D>
void begin_sweeps(Model<D>& m)
{
  if (m.work.strips)
    return;
  m.work.strips.emplace();
  const bool keep = m.transfer->keeps_gradients() || m.problem.columns.reference || rigid_bodies_use_affine_fields(m);
  m.work.strips->load(*m.problem.ranks, m.problem.mesh.n_cells(), keep, m.state.bodies, m.state.materials, m.state.particles, m.work.order);
  find_averaged_bodies(m);
  if (m.work.strips->layout().step_arrays().jump_stress != none && may_have_jump_stress(m) && !m.work.jump_stress)
    m.work.jump_stress.emplace(*m.problem.ranks, m.problem.subdomain, m.problem.mesh);
  m.work.due.assign(m.problem.columns.reference ? m.work.strips->keys() : 0, 0);
  m.transfer->sum_strips(m);
}

template <int D>
void copy_to_columns(Model<D>& m)
{
  if (m.work.strips && m.state.particles.id.empty())
    m.work.strips->store(
        m.state.bodies, m.state.materials, m.state.particles, m.work.order,
        [&m](std::size_t key, Index strip, StripColumns<D>& columns) { m.transfer->find_gradients(m, key, strip, columns); });
}

template <int D>
void drop_copy(Model<D>& m)
{
  if (m.work.strips && !m.state.particles.id.empty())
    m.work.strips->clear(m.state.materials, m.state.particles, m.work.order);
}

template <int D>
std::optional<ParticleCopy<D>> take_copy(Model<D>& m)
{
  if (!m.work.strips)
    return std::nullopt;
  copy_to_columns(m);
  ParticleCopy<D> copy{m.state.bodies, {}, std::exchange(m.state.particles, {})};
  for (Material& material : m.state.materials) {
    Material& taken = copy.materials.emplace_back(material.without_particles());
    taken.begin = material.begin, taken.end = material.end;
    taken.history = std::exchange(material.history, HistoryRows(material.history.width()));
  }
  m.work.order.row = {};
  return copy;
}

template <int D>
void end_sweeps(Model<D>& m)
{
  if (!m.work.strips)
    return;
  copy_to_columns(m);
  m.work.strips.reset();
}

template <int D>
Totals<D> totals(const Model<D>& m)
{
  if (m.work.strips)
    return totals(*m.work.strips, *m.problem.ranks);
  return totals(m.state.particles, m.work.order, *m.problem.ranks);
}

#define TALUS_INSTANTIATE(D)                                                             \
  template struct Model<D>;                                                              \
  template void fill_columns(const WantedColumns&, Particles<D>&);                       \
  template void make_ready(Model<D>&, std::span<const std::vector<Material>>);           \
  template void update_rows(Model<D>&);                                                  \
  template void adopt_state(Model<D>&);                                                  \
  template void bind_boundary_conditions(Model<D>&);                                     \
  template void find_forces(const Model<D>&, Real, const StripColumns<D>&, std::size_t); \
  template std::optional<PoreWater> pore_water(const Model<D>&, Index, Real);            \
  template bool rigid_bodies_use_affine_fields(const Model<D>&);                         \
  template void begin_sweeps(Model<D>&);                                                 \
  template void end_sweeps(Model<D>&);                                                   \
  template void copy_to_columns(Model<D>&);                                              \
  template void drop_copy(Model<D>&);                                                    \
  template std::optional<ParticleCopy<D>> take_copy(Model<D>&);                          \
  template Totals<D> totals(const Model<D>&);
TALUS_INSTANTIATE(2)
TALUS_INSTANTIATE(3)
#undef TALUS_INSTANTIATE

}  // namespace talus
