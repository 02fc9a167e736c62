#include "app/setup.hpp"

#include <algorithm>
#include <stdexcept>

#include "app/expression.hpp"
#include "app/fields.hpp"
#include "app/guards.hpp"
#include "app/history.hpp"
#include "app/k0.hpp"
#include "app/laws_in_force.hpp"
#include "app/runout.hpp"
#include "app/seed.hpp"
#include "app/upright.hpp"
#include "app/water.hpp"
#include "core/exchange.hpp"
#include "core/parallel.hpp"
#include "io/history_columns.hpp"
#include "io/scene_rules.hpp"
#include "materials/strength.hpp"
#include "mesh/digest.hpp"

namespace talus {

namespace {

template <int D>
Vec<D> vector_of(const std::vector<Real>& numbers)
{
  return numbers.empty() ? Vec<D>(Vec<D>::Zero()) : Vec<D>(Eigen::Map<const Vec<D>>(numbers.data()));
}

/// Which cells have material, on any rank, where bodies are placed.  Every rank has to ask.
template <int D>
class Filled {
 public:
  /// By the bodies that are `there`, by their names.
  template <class There>
  Filled(const Mesh<D>& mesh, const Particles<D>& particles, const std::vector<Body>& bodies, Exchange& ranks, There&& there)
      : mesh_(mesh), filled_(static_cast<std::size_t>(mesh.n_cells() / cells_in_word + 1), 0)
  {
    for (const Body& body : bodies)
      for (Index row = body.begin; there(body.name) && row < body.end; ++row) {
        const Index c = particles.cell[static_cast<std::size_t>(row)];
        filled_[word_of(c)] |= bit_of(c);
      }
    ranks.sum(filled_);  // no cell is filled by two ranks
  }
  bool operator()(Index cell) const { return (filled_[word_of(cell)] & bit_of(cell)) != 0; }
  /// Facets of a group inside the mesh belong to the side that has material, if only one has; where neither has, to that which material
  /// reaches first, from cell to cell and not through the group: so it comes to an obstacle from outside.
  std::vector<Facet> seen_from_material(std::vector<Facet> facets) const
  {
    std::vector<Index> way;  // found when it is needed
    for (Facet& facet : facets) {
      const Index other = across(facet);
      if (other == none || ((*this)(facet.cell) && (*this)(other)))
        continue;
      if (way.empty() && !(*this)(facet.cell) && !(*this)(other))
        way = cells_from_material(facets);
      const auto far = [&](Index cell) { return (*this)(cell) ? 0 : way.empty() ? 1 : way[static_cast<std::size_t>(cell)]; };
      if (far(other) < far(facet.cell))
        facet = back(facet);
    }
    return facets;
  }
  /// Facets with material on both sides.
  Index inside_material(const std::vector<Facet>& facets) const
  {
    return static_cast<Index>(std::count_if(
        facets.begin(), facets.end(), [&](Facet facet) { return across(facet) != none && (*this)(facet.cell) && (*this)(across(facet)); }));
  }

 private:
  Index across(Facet facet) const { return mesh_.neighbours(facet.cell)[static_cast<std::size_t>(facet.local)]; }
  /// The same facet, seen from its other cell.
  Facet back(Facet facet) const
  {
    const auto& neighbours = mesh_.neighbours(across(facet));
    return {across(facet), static_cast<Index>(std::find(neighbours.begin(), neighbours.end(), facet.cell) - neighbours.begin())};
  }
  /// Of each cell how many cells away the nearest material is, the facets being closed.
  std::vector<Index> cells_from_material(const std::vector<Facet>& closed) const
  {
    std::vector<std::uint8_t> shut(static_cast<std::size_t>(mesh_.n_cells()), 0);
    const auto shut_one = [&](Facet facet) { shut[static_cast<std::size_t>(facet.cell)] |= static_cast<std::uint8_t>(1 << facet.local); };
    for (const Facet facet : closed) {
      shut_one(facet);
      if (across(facet) != none)
        shut_one(back(facet));
    }
    std::vector<Index> far(shut.size(), std::numeric_limits<Index>::max()), next;
    for (Index c = 0; c < mesh_.n_cells(); ++c)
      if ((*this)(c))
        far[static_cast<std::size_t>(c)] = 0, next.push_back(c);
    for (std::size_t i = 0; i < next.size(); ++i)
      for (Index local = 0; local <= D; ++local) {
        const auto c = static_cast<std::size_t>(next[i]);
        const Index other = across({next[i], local});
        if (other == none || (shut[c] >> local & 1) != 0 || far[static_cast<std::size_t>(other)] <= far[c] + 1)
          continue;
        far[static_cast<std::size_t>(other)] = far[c] + 1;
        next.push_back(other);
      }
    return far;
  }

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

/// Boundaries, one after the other -> walls of a stage, called by its name.
template <int D>
class WallBuilder {
 public:
  /// `first`: of the first stage, in which what is worth a word is told.
  WallBuilder(const Scene& scene, const Mesh<D>& mesh, const Filled<D>& has_particles, Exchange& ranks, const std::string& stage,
              bool first, Complaints& complaints, Setup<D>& setup, Walls<D>& walls)
      : folder_(folder_of(scene)),
        mesh_(mesh),
        has_particles_(has_particles),
        stage_(stage),
        first_(first),
        up_(upright_of(scene).head<D>()),
        ranks_(ranks),
        complaints_(complaints),
        setup_(setup),
        walls_(walls)
  {}
  /// Free fields come last: they stand on others.
  void add(const std::vector<BoundarySpec>& boundaries)
  {
    const auto names = wall_names(boundaries);
    for (const bool free_fields : {false, true})
      for (std::size_t i = 0; i < names.size(); ++i)
        if (std::holds_alternative<FreeFieldSpec>(boundaries[i]) == free_fields) {
          name_ = names[i];
          std::visit(*this, boundaries[i]);
        }
  }

  void operator()(const FixedSpec& spec) { on_nodes(spec, wall_of(spec, WallKind::fixed)); }
  void operator()(const VelocitySpec& spec)
  {
    Wall<D> wall = wall_of(spec, WallKind::velocity);
    set_motion(spec, wall);
    on_nodes(spec, std::move(wall));
  }
  void operator()(const CompliantBaseSpec& spec)
  {
    Wall<D> wall = wall_of(spec, WallKind::compliant_base);
    wall.halfspace = {spec.density, spec.s_wave, spec.p_wave};
    set_motion(spec, wall);
    on_facets(spec, std::move(wall));
  }
  void operator()(const FreeFieldSpec& spec)
  {
    Wall<D> wall = wall_of(spec, WallKind::free_field);
    const auto found = mesh_.facet_set(spec.on);
    if (!found)
      return complaints_.unknown_group(spec.where, "on", "facet", spec.on, mesh_.facet_set_names());
    const std::vector<Facet> facets = has_particles_.seen_from_material(*found);
    constexpr Real upright = 0.01;  // cosine between a facet's normal and the upright
    Index lowest = none;
    for (const Facet facet : facets) {
      const Vec<D> area = mesh_.area_vector(facet);
      if (std::abs(area.dot(up_)) > upright * area.norm())
        return complaints_.add(spec.where, "on", fmt::format("the facets of \"{}\" are not all upright", spec.on));
      for (const Index n : mesh_.nodes_of(facet))
        if (lowest == none || mesh_.node(n).dot(up_) < mesh_.node(lowest).dot(up_))
          lowest = n;
    }
    const auto column = column_beside<D>(mesh_, facets, up_, setup_.particles, setup_.materials, ranks_);
    wall.foot = lowest == none ? none : walls_.holder_of(lowest);
    if (!column)
      return complaints_.add(
          spec.where, "on",
          fmt::format("behind the facets of \"{}\", from their foot up, there must be particles of laws that have an elastic shear modulus",
                      spec.on));
    if (wall.foot == none)
      return complaints_.add(spec.where, "on",
                             fmt::format("no boundary of type fixed, velocity or compliant_base holds the foot of \"{}\"", spec.on));
    wall.column = *column;
    const Halfspace &lowest_layer = wall.column.layer.front().ground, &highest_layer = wall.column.layer.back().ground;
    if (first_)
      setup_.notes.push_back(fmt::format(
          "free field \"{}\": {} layers over {:.4g} m, shear waves {:.4g} m/s at the foot and {:.4g} m/s at the ground", spec.on,
          wall.column.layer.size(), wall.column.level.back() - wall.column.level.front(), lowest_layer.s_wave, highest_layer.s_wave));
    walls_.add(std::move(wall), mesh_, facets);
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
    wall.name = name_;
    wall.kind = kind;
    wall.where = spec.where;
    return wall;
  }
  template <class Spec>
  void set_motion(const Spec& spec, Wall<D>& wall)
  {
    wall.velocity = vector_of<D>(spec.velocity);
    wall.table = spec.table;
    if (!spec.record)
      return;
    try {
      wall.record = read_record((folder_ / spec.record->file).lexically_normal(), *spec.record);
    } catch (const SceneErrors& e) {
      return complaints_.add(spec.where, "record.file", e);
    }
    if (!first_)
      return;
    setup_.notes.push_back(describe(*spec.record, *wall.record));
    constexpr Real noticed = 0.01;  // share of the peak
    const Real left = std::abs(wall.record->velocity.back());
    if (left > noticed * wall.record->peak_velocity())
      setup_.warnings.push_back(
          fmt::format("{}: \"{}\" ends with {:.3g} m/s, and its velocity stays so after its end; record.baseline takes such a drift off",
                      to_string(spec.where), spec.record->file, left));
  }
  template <class Spec>
  void on_nodes(const Spec& spec, Wall<D> wall)
  {
    const auto nodes = mesh_.node_set(spec.on);
    if (nodes && acts_in(spec, stage_))
      walls_.add(std::move(wall), mesh_, *nodes);
    else if (nodes)
      walls_.add(std::move(wall));
    else
      complaints_.unknown_group(spec.where, "on", "node, facet or cell", spec.on, mesh_.node_set_names());
  }
  template <class Spec>
  void on_facets(const Spec& spec, Wall<D> wall)
  {
    const auto facets = mesh_.facet_set(spec.on);
    if (facets && acts_in(spec, stage_)) {
      if (const Index inside = has_particles_.inside_material(*facets); inside > 0 && wall.kind == WallKind::friction)
        setup_.warnings.push_back(fmt::format(
            "{}: {} of the {} facets of \"{}\" have material on both sides{}: a friction wall holds that on one of them, and "
            "which is not said",
            to_string(spec.where), inside, facets->size(), spec.on, stage_.empty() ? "" : fmt::format(" in stage \"{}\"", stage_)));
      walls_.add(std::move(wall), mesh_, has_particles_.seen_from_material(*facets));
    } else if (facets) {
      walls_.add(std::move(wall));
    } else
      complaints_.unknown_group(spec.where, "on", "facet", spec.on, mesh_.facet_set_names());
  }

  std::filesystem::path folder_;
  const Mesh<D>& mesh_;
  const Filled<D>& has_particles_;
  const std::string& stage_;
  bool first_;
  std::string name_;  // of the wall at hand
  Vec<D> up_;
  Exchange& ranks_;
  Complaints& complaints_;
  Setup<D>& setup_;
  Walls<D>& walls_;
};

template <int D>
class LoadBuilder {
 public:
  /// `has_particles`: of all bodies, those as well that appear later; `at_start`: of the others.
  LoadBuilder(const Mesh<D>& mesh, const Filled<D>& has_particles, const Filled<D>& at_start, Exchange& ranks, Complaints& complaints,
              Setup<D>& setup)
      : mesh_(mesh), has_particles_(has_particles), at_start_(at_start), ranks_(ranks), complaints_(complaints), setup_(setup)
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
    const std::vector<Facet> facets = at_start_.seen_from_material(*found);
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
  const Filled<D>&has_particles_, &at_start_;
  Exchange& ranks_;
  Complaints& complaints_;
  Setup<D>& setup_;
};

Stage stage_of(const RunSpec& spec) { return {.duration = spec.duration, .damping = spec.damping, .where = spec.where}; }
Stage stage_of(const GeostaticSpec& spec)
{
  return {.duration = spec.duration,
          .damping = spec.damping,
          .ramp = spec.ramp,
          .elastic = spec.elastic,
          .residual = spec.residual,
          .k0 = {},
          .reset_displacement = spec.reset_displacement,
          .where = spec.where};
}
Stage stage_of(const StageSpec& spec)
{
  Stage stage = std::visit([](const auto& s) { return stage_of(s); }, spec);
  stage.name = name_of(spec);
  stage.kind = std::visit([]<class Spec>(const Spec&) { return std::string(Spec::name); }, spec);
  return stage;
}

/// The numbers of bodies that are named.
std::vector<Index> numbers_of(const std::vector<std::string>& names, const std::vector<Body>& bodies)
{
  std::vector<Index> numbers;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (std::find(names.begin(), names.end(), bodies[b].name) != names.end())
      numbers.push_back(static_cast<Index>(b));
  return numbers;
}

template <int D>
void set_stages(const Scene& scene, Complaints& complaints, Setup<D>& setup)
{
  if (scene.stages.empty())
    setup.stages.push_back({.name = "run", .duration = scene.time.end, .where = scene.time.where});
  for (const StageSpec& spec : scene.stages)
    setup.stages.push_back(stage_of(spec));
  for (std::size_t s = 0; s < scene.stages.size(); ++s) {
    Stage& stage = setup.stages[s];
    const auto* spec = std::get_if<GeostaticSpec>(&scene.stages[s]);
    if (spec == nullptr || !spec->initial_stress)
      continue;
    stage.k0 = k0_of_bodies(*spec->initial_stress, scene, complaints);
    if (s > 0)
      stage.k0_bodies = numbers_of(changes_of(scene.stages[s]).appear, setup.bodies);
    for (std::size_t b = 0; b < setup.bodies.size(); ++b) {
      const Index from = presence_of(setup.bodies[b].name, scene.stages).from;
      if (std::cmp_equal(from, s) && !can_start_from_stress(setup.materials[b]))
        complaints.add(
            stage.where, "initial_stress",
            fmt::format("law \"{}\" of body \"{}\" cannot start from a stress; leave initial_stress out and let gravity grow (ramp)",
                        law_name(setup.materials[b]), setup.bodies[b].name));
    }
  }
}

/// Whether a law has strength, as far as its scene is concerned.
bool has_strength(const MaterialSpec& material)
{
  return std::visit([]<class L>(const L&) { return HasStrength<L>; }, material.law);
}

/// What the laws of bodies say to what stages want of them.
void check_laws(const Scene& scene, Complaints& complaints)
{
  const auto body_of = [&](const std::string& name) {
    return std::find_if(scene.bodies.begin(), scene.bodies.end(), [&](const BodySpec& body) { return body.name == name; });
  };
  for (std::size_t s = 0; s < scene.stages.size(); ++s) {
    const auto stage = static_cast<Index>(s);
    for (const NewMaterialSpec& change : changes_of(scene.stages[s]).change) {
      const MaterialSpec &before = *material_of(scene, *body_of(change.body), stage - 1),
                         &after = *material_of(scene, *body_of(change.body), stage);
      const auto name = [](const MaterialSpec& material) { return std::visit([]<class L>(const L&) { return L::name; }, material.law); };
      const auto can = laws_that_start_from_stress();
      if (name(before) != name(after) && std::find(can.begin(), can.end(), name(after)) == can.end())
        complaints.add(change.where, "material",
                       fmt::format("the body comes from law \"{}\", and law \"{}\" cannot start from its stress; of other laws {} can",
                                   name(before), name(after), or_list(can)));
    }
    for (const WeakenSpec& weaken : changes_of(scene.stages[s]).weaken) {
      const bool any = std::any_of(scene.bodies.begin(), scene.bodies.end(), [&](const BodySpec& body) {
        return (weaken.body.empty() || body.name == weaken.body) && presence_of(body.name, scene.stages).in(stage) &&
               has_strength(*material_of(scene, body, stage));
      });
      if (!any)
        complaints.add(weaken.where, weaken.body.empty() ? "" : "body",
                       weaken.body.empty() ? std::string("no body of this stage has a law with shear strength")
                                           : fmt::format("the law of body \"{}\" has no shear strength", weaken.body));
    }
  }
}

/// In words what becomes of the law of a body in a stage; empty if it stays what it is.
std::string renewal(const Scene& scene, const BodySpec& body, Index stage)
{
  if (stage == 0 || !presence_of(body.name, scene.stages).in(stage - 1))
    return {};
  const MaterialSpec &before = *material_of(scene, body, stage - 1), &after = *material_of(scene, body, stage);
  const Real weaker = weakened_by(scene, body, stage) / (&before == &after ? weakened_by(scene, body, stage - 1) : 1);
  const bool changes = &before != &after, weakens = weaker != 1 && has_strength(after);
  std::string text = changes ? fmt::format("goes on as \"{}\"", after.name) : "";
  if (weakens)
    text += fmt::format("{}has its strength divided by {:.6g}", changes ? " and " : "", weaker);
  return text;
}

/// Bodies that come are not where others are, as far as it is known where these will be.
template <int D>
void check_room(const Scene& scene, const Mesh<D>& mesh, const Setup<D>& setup, Exchange& ranks, Complaints& complaints)
{
  CellOrder order;
  for (std::size_t s = 1; s < scene.stages.size(); ++s)
    for (const std::string& name : changes_of(scene.stages[s]).appear) {
      if (order.row.empty())
        sort_by_cell(setup.particles.cell, setup.particles.id, setup.bodies, mesh.n_cells(), order);
      const auto volumes = [&](const auto& chosen) {
        return volume_in_cells(mesh, setup.particles, order,
                               [&](Index b) { return chosen(setup.bodies[static_cast<std::size_t>(b)].name); });
      };
      const auto its = volumes([&](const std::string& body) { return body == name; });
      const auto there =
          volumes([&](const std::string& body) { return body != name && presence_of(body, scene.stages).in(static_cast<Index>(s)); });
      if (const Overlap<D> taken = overlap<D>(mesh, there, its, ranks); taken.share() > most_overlap)
        complaints.add(where_of(scene.stages[s]), "appear", fmt::format("body \"{}\" cannot appear: {}", name, describe(taken)));
    }
}

/// What the stages change, the bodies being there that appear later: these are taken away.
template <int D>
void set_changes(const Scene& scene, const Mesh<D>& mesh, Exchange& ranks, Setup<D>& setup)
{
  const std::size_t n = setup.stages.size();
  setup.changes.resize(n);
  setup.laws = laws_of_stages(scene);
  const auto said = [&](std::size_t s) -> const StageChanges& { return changes_of(scene.stages[s]); };
  const bool bodies_differ = std::any_of(scene.stages.begin(), scene.stages.end(), [](const StageSpec& stage) {
    return !changes_of(stage).appear.empty() || !changes_of(stage).vanish.empty();
  });
  const bool walls_differ = bodies_differ || std::any_of(scene.boundaries.begin(), scene.boundaries.end(),
                                                         [](const BoundarySpec& boundary) { return !during_of(boundary).empty(); });
  const auto names = wall_names(scene.boundaries);
  Complaints none_left(scene);  // groups have been looked at
  for (std::size_t s = 1; s < n; ++s) {
    StageChange<D>& change = setup.changes[s];
    change.appear = numbers_of(said(s).appear, setup.bodies);
    change.vanish = numbers_of(said(s).vanish, setup.bodies);
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
      if (std::string becomes = renewal(scene, scene.bodies[b], static_cast<Index>(s)); !becomes.empty())
        change.renew.push_back({static_cast<Index>(b), std::move(becomes)});
    if (!walls_differ)
      continue;
    const auto there = [&](const std::string& body) { return presence_of(body, scene.stages).in(static_cast<Index>(s)); };
    const Filled<D> filled(mesh, setup.particles, setup.bodies, ranks, there);
    change.walls.emplace();
    WallBuilder<D>(scene, mesh, filled, ranks, said(s).label, false, none_left, setup, *change.walls).add(scene.boundaries);
    for (std::size_t w = 0; w < names.size(); ++w) {
      const bool acted = acts_in(scene.boundaries[w], said(s - 1).label), acts = acts_in(scene.boundaries[w], said(s).label);
      if (acted != acts)
        change.told.push_back(fmt::format("wall \"{}\" {}", names[w], acts ? "acts from here on" : "is gone"));
    }
  }
  for (std::size_t s = 1; s < n; ++s)
    if (!setup.changes[s].appear.empty())
      setup.changes[s].coming = take_out_bodies<D>(setup.changes[s].appear, setup.bodies, setup.materials, setup.particles);
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

template <int D>
std::uint64_t digest_of_files(const Setup<D>& setup)
{
  std::vector<Real> numbers = setup.water.table;
  for (const Wall<D>& wall : setup.walls.walls())
    if (wall.record)
      for (const std::vector<Real>* part : {&wall.record->time, &wall.record->velocity, &wall.record->acceleration})
        numbers.insert(numbers.end(), part->begin(), part->end());
  return digest(std::span<const Real>(numbers));
}

bool wants_displacement(const OutputSpec& outputs)
{
  if (outputs.runout || (outputs.history && (!outputs.history->points.empty() || !outputs.history->moved.empty())))
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
  const std::vector<std::uint8_t>& drained = setup.water.drained;
  if (std::none_of(drained.begin(), drained.end(), [](std::uint8_t is) { return is != 0; }))
    return;
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

/// Sections that leave the mesh, walls of the history that have no area.
template <int D>
void check_outputs(const Scene& scene, const Mesh<D>& mesh, const Vec<D>& gravity, Complaints& complaints)
{
  if (const auto& history = scene.outputs.history)
    for (const WallSpec& wall : history->walls)
      if (!facets_of_wall(mesh, wall.on))
        complaints.add(wall.where, "on", fmt::format("wall \"{}\" is on nodes, not on facets: it has no area", wall.on));
  if (D == 2 || !scene.outputs.runout)
    return;
  const PlanAxes axes = plan_axes<D>(gravity);
  for (const SectionSpec& section : scene.outputs.runout->sections)
    for (std::size_t i = 0; i < section.along.size(); ++i)
      for (std::size_t d = 0; d < 2; ++d) {
        const Real shift = mesh.map() ? mesh.map()->origin[d] : 0;
        const Real low = mesh.low()[axes.plan[d]] + shift, high = mesh.high()[axes.plan[d]] + shift;
        if (const Real x = section.along[i][d]; !(low <= x && x <= high))
          complaints.add(
              section.where, "along",
              fmt::format("corner {} is outside of the mesh: {:.10g} m does not lie between {:.10g} and {:.10g} m", i + 1, x, low, high));
      }
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
  const Filled<D> has_particles(mesh, setup.particles, setup.bodies, ranks, [](const std::string&) { return true; });
  const Filled<D> at_start(mesh, setup.particles, setup.bodies, ranks,
                           [&](const std::string& body) { return presence_of(body, scene.stages).from == 0; });
  const std::string first_stage = scene.stages.empty() ? "" : changes_of(scene.stages.front()).label;
  WallBuilder<D>(scene, mesh, at_start, ranks, first_stage, true, complaints, setup, setup.walls).add(scene.boundaries);
  LoadBuilder<D> loads(mesh, has_particles, at_start, ranks, complaints, setup);
  for (const LoadSpec& load : scene.loads)
    std::visit(loads, load);
  set_stages(scene, complaints, setup);
  setup.water = water_of(
      scene, mesh, setup.bodies, [&](Index cell) { return at_start(cell); }, complaints, setup.warnings);
  saturate(scene, mesh, setup.water, setup.bodies, setup.particles);
  if (setup.water.any())
    warn_if_dry(mesh, ranks, setup);
  check_laws(scene, complaints);
  check_room(scene, mesh, setup, ranks, complaints);
  check_picture(scene, complaints);
  check_outputs<D>(scene, mesh, setup.loads.gravity.acceleration, complaints);
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
  setup.from_files = digest_of_files(setup);
  set_changes(scene, mesh, ranks, setup);
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
