#include "app/setup.hpp"

#include <algorithm>
#include <stdexcept>

#include "app/expression.hpp"
#include "app/fields.hpp"
#include "app/guards.hpp"
#include "app/k0.hpp"
#include "app/seed.hpp"
#include "app/water.hpp"
#include "core/exchange.hpp"
#include "core/parallel.hpp"
#include "io/history_columns.hpp"
#include "io/scene_rules.hpp"

namespace talus {

namespace {

template <int D>
Vec<D> vector_of(const std::vector<Real>& numbers)
{
  return numbers.empty() ? Vec<D>(Vec<D>::Zero()) : Vec<D>(Eigen::Map<const Vec<D>>(numbers.data()));
}

/// Which cells have material at the start, on any rank.  Every rank has to ask.
template <int D>
class Filled {
 public:
  Filled(const Mesh<D>& mesh, const Particles<D>& particles, Exchange& ranks)
      : mesh_(mesh), filled_(static_cast<std::size_t>(mesh.n_cells() / cells_in_word + 1), 0)
  {
    for (const Index c : particles.cell)
      filled_[word_of(c)] |= bit_of(c);
    ranks.sum(filled_);  // no cell is filled by two ranks
  }
  bool operator()(Index cell) const { return (filled_[word_of(cell)] & bit_of(cell)) != 0; }
  /// A facet inside the mesh belongs to the side that has material, if only one has.
  Facet seen_from_material(Facet facet) const
  {
    const Index other = mesh_.neighbours(facet.cell)[static_cast<std::size_t>(facet.local)];
    if (other == none || (*this)(facet.cell) || !(*this)(other))
      return facet;
    const auto& back = mesh_.neighbours(other);
    return {other, static_cast<Index>(std::find(back.begin(), back.end(), facet.cell) - back.begin())};
  }
  std::vector<Facet> seen_from_material(std::vector<Facet> facets) const
  {
    for (Facet& facet : facets)
      facet = seen_from_material(facet);
    return facets;
  }

 private:
  static constexpr Index cells_in_word = 32;
  static std::size_t word_of(Index cell) { return static_cast<std::size_t>(cell / cells_in_word); }
  static std::int64_t bit_of(Index cell) { return std::int64_t{1} << (cell % cells_in_word); }

  const Mesh<D>& mesh_;
  std::vector<std::int64_t> filled_;
};

/// What each rank has found behind facets, its own particles, becomes that of all.  Every rank has to ask.
template <int D>
void join(Exchange& ranks, ParticleTraction<D>& load)
{
  struct Loaded {
    std::int64_t id;
    std::array<Real, D> area;
  };
  if (ranks.alone())
    return;
  std::vector<Loaded> all;
  for (std::size_t k = 0; k < load.id.size(); ++k) {
    Loaded& one = all.emplace_back();
    one.id = load.id[k];
    std::copy(load.area[k].begin(), load.area[k].end(), one.area.begin());
  }
  const auto of_ranks = gather_rows<Loaded>(ranks, all);
  all.clear();
  for (const std::vector<Loaded>& of_rank : of_ranks)
    all.insert(all.end(), of_rank.begin(), of_rank.end());
  std::sort(all.begin(), all.end(), [](const Loaded& a, const Loaded& b) { return a.id < b.id; });
  const auto bytes = std::as_bytes(std::span(all));
  std::vector<std::byte> letter(bytes.begin(), bytes.end());
  ranks.broadcast(letter, 0);
  load.id.clear(), load.area.clear();
  const auto letters = rows_of<Loaded>({std::move(letter)});
  for (const Loaded& one : letters.front()) {
    load.id.push_back(one.id);
    load.area.push_back(Eigen::Map<const Vec<D>>(one.area.data()));
  }
}

/// Boundaries, one after the other -> walls.
template <int D>
class WallBuilder {
 public:
  WallBuilder(const Mesh<D>& mesh, const Filled<D>& has_particles, std::vector<std::string> names, Complaints& complaints, Walls<D>& walls)
      : mesh_(mesh), has_particles_(has_particles), names_(std::move(names)), complaints_(complaints), walls_(walls)
  {}

  void operator()(const FixedSpec& spec) { on_nodes(spec, wall_of(spec, WallKind::fixed)); }
  void operator()(const VelocitySpec& spec)
  {
    Wall<D> wall = wall_of(spec, WallKind::velocity);
    wall.velocity = vector_of<D>(spec.velocity);
    wall.table = spec.table;
    on_nodes(spec, std::move(wall));
  }
  void operator()(const RollerSpec& spec) { on_facets(spec, wall_of(spec, WallKind::roller)); }
  void operator()(const FrictionSpec& spec)
  {
    Wall<D> wall = wall_of(spec, WallKind::friction);
    wall.friction = spec.coefficient;
    on_facets(spec, std::move(wall));
  }

 private:
  template <class Spec>
  Wall<D> wall_of(const Spec& spec, WallKind kind)
  {
    Wall<D> wall;
    wall.name = names_[next_++];
    wall.kind = kind;
    wall.where = spec.where;
    return wall;
  }
  template <class Spec>
  void on_nodes(const Spec& spec, Wall<D> wall)
  {
    if (const auto nodes = mesh_.node_set(spec.on))
      walls_.add(std::move(wall), mesh_, *nodes);
    else
      complaints_.unknown_group(spec.where, "on", "node, facet or cell", spec.on, mesh_.node_set_names());
  }
  template <class Spec>
  void on_facets(const Spec& spec, Wall<D> wall)
  {
    if (const auto facets = mesh_.facet_set(spec.on))
      walls_.add(std::move(wall), mesh_, has_particles_.seen_from_material(*facets));
    else
      complaints_.unknown_group(spec.where, "on", "facet", spec.on, mesh_.facet_set_names());
  }

  const Mesh<D>& mesh_;
  const Filled<D>& has_particles_;
  std::vector<std::string> names_;  // of the walls, in the order of the boundaries
  std::size_t next_ = 0;
  Complaints& complaints_;
  Walls<D>& walls_;
};

template <int D>
class LoadBuilder {
 public:
  LoadBuilder(const Mesh<D>& mesh, const Filled<D>& has_particles, Exchange& ranks, Complaints& complaints, Setup<D>& setup)
      : mesh_(mesh), has_particles_(has_particles), ranks_(ranks), complaints_(complaints), setup_(setup)
  {}

  void operator()(const GravitySpec& spec) { setup_.loads.gravity = {vector_of<D>(spec.acceleration), spec.table}; }
  void operator()(const BodyForceSpec& spec)
  {
    std::vector<Formula> formulas;
    for (std::size_t d = 0; d < spec.acceleration.size(); ++d)
      try {
        formulas.emplace_back(spec.acceleration[d]);
      } catch (const std::invalid_argument& e) {
        complaints_.add(spec.where, fmt::format("acceleration[{}]", d), e.what());
      }
    if (formulas.size() < D)
      return;
    setup_.loads.of_place.push_back({[formulas](const Vec<D>& place, Real time) {
                                       Vec3 at = Vec3::Zero();
                                       at.template head<D>() = place;
                                       Vec<D> acceleration;
                                       for (int d = 0; d < D; ++d)
                                         acceleration[d] = formulas[static_cast<std::size_t>(d)](at, time);
                                       return acceleration;
                                     },
                                     spec.place == PlaceOf::start});
  }
  void operator()(const TractionSpec& spec)
  {
    const auto found = mesh_.facet_set(spec.on);
    if (!found)
      return complaints_.unknown_group(spec.where, "on", "facet", spec.on, mesh_.facet_set_names());
    const std::vector<Facet> facets = has_particles_.seen_from_material(*found);
    Real area = 0, loaded = 0;
    for (const Facet& facet : facets) {
      area += mesh_.area_vector(facet).norm();
      loaded += has_particles_(facet.cell) ? mesh_.area_vector(facet).norm() : 0;
    }
    if (loaded == 0)
      return complaints_.add(spec.where, "on",
                             fmt::format("there are no particles behind the facets of \"{}\" to carry the load", spec.on));
    if (loaded < area * (1 - 1e-9))  // sums of the same areas differ by round-off only
      setup_.warnings.push_back(fmt::format("{}: {:.3g} % of the area of \"{}\" has no particles behind it and carries no load",
                                            to_string(spec.where), 100 * (1 - loaded / area), spec.on));
    if (spec.carried_by == Carrier::particles) {
      auto load = carried_by_particles<D>(mesh_, facets, setup_.particles);
      join(ranks_, load);
      setup_.loads.on_particles.push_back(filled(std::move(load), spec));
    } else {
      setup_.loads.on_mesh.push_back(filled(carried_by_mesh<D>(mesh_, facets), spec));
    }
  }

 private:
  template <class Load>
  static Load filled(Load load, const TractionSpec& spec)
  {
    load.traction = vector_of<D>(spec.traction);
    load.pressure = spec.pressure.value_or(0);
    load.table = spec.table;
    load.where = spec.where;
    return load;
  }

  const Mesh<D>& mesh_;
  const Filled<D>& has_particles_;
  Exchange& ranks_;
  Complaints& complaints_;
  Setup<D>& setup_;
};

Stage stage_of(const std::string& name, Real duration, Real damping, const Where& where)
{
  Stage stage;
  stage.name = name;
  stage.duration = duration;
  stage.damping = damping;
  stage.where = where;
  return stage;
}
Stage stage_of(const RunSpec& spec) { return stage_of("run", spec.duration, spec.damping, spec.where); }
Stage stage_of(const GeostaticSpec& spec)
{
  return {.name = "geostatic",
          .duration = spec.duration,
          .damping = spec.damping,
          .ramp = spec.ramp,
          .elastic = spec.elastic,
          .residual = spec.residual,
          .k0 = {},
          .reset_displacement = spec.reset_displacement,
          .where = spec.where};
}

template <int D>
void set_stages(const Scene& scene, Complaints& complaints, Setup<D>& setup)
{
  if (scene.stages.empty())
    setup.stages.push_back(stage_of("run", scene.time.end, 0, scene.time.where));
  for (const StageSpec& spec : scene.stages)
    setup.stages.push_back(std::visit([](const auto& s) { return stage_of(s); }, spec));
  for (std::size_t s = 0; s < scene.stages.size(); ++s)
    if (const auto* spec = std::get_if<GeostaticSpec>(&scene.stages[s]); spec != nullptr && spec->initial_stress)
      setup.stages[s].k0 = k0_of_bodies(*spec->initial_stress, scene, complaints);
  for (const Stage& stage : setup.stages)
    for (std::size_t b = 0; !stage.k0.empty() && b < setup.bodies.size(); ++b)
      if (!can_start_from_stress(setup.materials[b]))
        complaints.add(
            stage.where, "initial_stress",
            fmt::format("law \"{}\" of body \"{}\" cannot start from a stress; leave initial_stress out and let gravity grow (ramp)",
                        law_name(setup.materials[b]), setup.bodies[b].name));
}

}  // namespace

Transfer transfer_of(const TransferSpec& spec)
{
  Transfer transfer;
  constexpr Scheme schemes[] = {Scheme::flip, Scheme::apic, Scheme::tpic, Scheme::aflip};  // in the order of TransferScheme
  transfer.scheme = schemes[static_cast<std::size_t>(spec.scheme)];
  transfer.musl = spec.musl.value_or(transfer.increments());
  transfer.pic_damping_time = spec.pic_damping_time;
  transfer.pic_damping_crossings = spec.pic_damping_crossings;
  if (transfer.scheme == Scheme::aflip && !spec.pic_damping_time && !spec.pic_damping_crossings)
    transfer.pic_damping_crossings = 25;  // measured: docs/kernels.md
  return transfer;
}

std::string describe(const OriginSummary& origin)
{
  std::string text = fmt::format("  from {}, step {}, t = {:.6g} s of \"{}\":\n", origin.file, origin.step, origin.time, origin.title);
  for (const auto& [body, from, particles] : origin.bodies)
    text += fmt::format("    body \"{}\": the {} particles of \"{}\"\n", body, particles, from);
  return text;
}

void take_threads(std::optional<int> asked, const Scene& scene)
{
  const Index wanted = asked.value_or(scene.threads);
  if (wanted > 0)
    set_threads(wanted);
  else if (!world().alone())
    set_threads(std::max(1, threads() / ranks_on_this_machine()));
}

std::filesystem::path folder_of(const Scene& scene) { return std::filesystem::path(scene.file).parent_path(); }

namespace {

bool wants_displacement(const OutputSpec& outputs)
{
  if (outputs.history && !outputs.history->points.empty())
    return true;
  if (!outputs.particles)
    return false;
  const auto fields = particle_fields_of(outputs);
  return std::find(fields.begin(), fields.end(), "displacement") != fields.end();
}

/// A table that no drained body reaches down to is hardly meant.  Every rank has to ask.
template <int D>
void warn_if_dry(const Mesh<D>& mesh, Exchange& ranks, Setup<D>& setup)
{
  std::int64_t wet = 0;
  for (std::size_t b = 0; b < setup.bodies.size(); ++b)
    if (setup.water.drains(static_cast<Index>(b)))
      wet += count_wet(mesh, setup.water, setup.bodies[b], setup.particles);
  if (ranks.sum(wet) == 0)
    setup.warnings.emplace_back("no particle of a drained body lies below the water table at the start");
}

/// The reader has checked the fields of files, but not the one of the picture, which may name a component behind a colon.
void check_picture(const Scene& scene, Complaints& complaints)
{
  if (!scene.outputs.particles)
    return;
  std::vector<std::string> known(particle_fields.begin(), particle_fields.end());
  known.emplace_back("body");
  for (const MaterialSpec& material : scene.materials)
    std::visit([&]<class Law>(
                   const Law&) { for_each_field<typename Law::State>([&](const auto& variable) { known.emplace_back(variable.key); }); },
               material.law);
  for (const std::string& name : particle_fields_of(scene.outputs))
    if (std::find(known.begin(), known.end(), name) == known.end())
      complaints.add(scene.where, "outputs.picture.field", fmt::format("there is no field \"{}\"{}", name, suggestion(name, known)));
}

}  // namespace

template <int D>
Setup<D> set_up(const Scene& scene, const Mesh<D>& mesh, Exchange& ranks)
{
  Complaints complaints(scene);
  Setup<D> setup;
  setup.warnings = mesh.notes();
  Seeds<D> seeds = seed(scene, mesh, ranks, complaints, setup.warnings);
  setup.particles = std::move(seeds.particles);
  setup.n_particles = seeds.n_particles;
  setup.bodies = std::move(seeds.bodies);
  setup.materials = std::move(seeds.materials);
  setup.origin = std::move(seeds.origin);
  const Filled<D> has_particles(mesh, setup.particles, ranks);
  WallBuilder<D> walls(mesh, has_particles, wall_names(scene.boundaries), complaints, setup.walls);
  for (const BoundarySpec& boundary : scene.boundaries)
    std::visit(walls, boundary);
  LoadBuilder<D> loads(mesh, has_particles, ranks, complaints, setup);
  for (const LoadSpec& load : scene.loads)
    std::visit(loads, load);
  set_stages(scene, complaints, setup);
  setup.water = water_of(
      scene, mesh, setup.bodies, [&](Index cell) { return has_particles(cell); }, complaints, setup.warnings);
  saturate(scene, mesh, setup.water, setup.bodies, setup.particles);
  if (setup.water.any())
    warn_if_dry(mesh, ranks, setup);
  check_picture(scene, complaints);
  ranks.agree(Exchange::caught([&] { complaints.throw_if_any(); }));

  setup.transfer = transfer_of(scene.transfer);
  setup.exits.policy = scene.on_exit == OnExit::stop ? OnExitPolicy::stop : OnExitPolicy::remove;
  setup.limits.cfl = scene.time.cfl.value();
  setup.limits.longest = scene.time.max_step.value_or(setup.limits.longest);
  setup.limits.shortest = scene.time.min_step;
  const auto from_start = [](const BodyForce<D>& load) { return load.at_start; };
  if (setup.particles.x0.empty() &&
      (wants_displacement(scene.outputs) || std::any_of(setup.loads.of_place.begin(), setup.loads.of_place.end(), from_start)))
    setup.particles.x0 = setup.particles.x;
  setup.guards = guards_of(scene, mesh, setup, ranks);
  return setup;
}

template <int D>
void restrict_to(const Share& share, Setup<D>& setup)
{
  setup.walls.restrict_to(share);
  restrict_to(share, setup.water);
  for (MeshTraction<D>& load : setup.loads.on_mesh)
    restrict_to(share, load);
}

template void restrict_to<2>(const Share&, Setup<2>&);
template void restrict_to<3>(const Share&, Setup<3>&);
template Setup<2> set_up<2>(const Scene&, const Mesh<2>&, Exchange&);
template Setup<3> set_up<3>(const Scene&, const Mesh<3>&, Exchange&);

}  // namespace talus
