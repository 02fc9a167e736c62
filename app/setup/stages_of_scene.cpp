#include "app/setup/stages_of_scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/setup/boundaries_of_scene.hpp"
#include "app/setup/laws_in_force.hpp"
#include "app/setup/water_table.hpp"
#include "io/scene/scene.hpp"
#include "materials/interface/law_variant.hpp"
#include "solver/stress/initial_stress.hpp"

namespace talus {

namespace {

/// Sine of the angle of friction in triaxial compression; nothing for a law that has none.
template <class Law>
std::optional<Real> sine_of_friction(const Law& law)
{
  if constexpr (requires { law.friction_angle; })
    return std::sin(law.friction_angle * (std::numbers::pi / 180));
  else if constexpr (requires { law.critical_state_slope; })
    return 3 * law.critical_state_slope / (6 + law.critical_state_slope);
  else
    return std::nullopt;
}

std::vector<std::string> laws_with_friction()
{
  std::vector<std::string> names;
  for_each_type(Laws{}, [&]<class L>() {
    if (sine_of_friction(L{}))
      names.emplace_back(L::name);
  });
  return names;
}

Table constant(Real value) { return {{{0, value}}}; }

/// (1 - sin phi) ocr^(sin phi), at most passive [Jaky 1944; Mayne & Kulhawy 1982].
Real from_friction(Real sine, Real ocr) { return std::min((1 - sine) * std::pow(ocr, sine), (1 + sine) / (1 - sine)); }

Mat3 matrix_of(const UniformStressSpec& s)
{
  Mat3 stress;
  stress << s.xx, s.xy, s.xz, s.xy, s.yy, s.yz, s.xz, s.yz, s.zz;
  return stress;
}

/// The key `initial_stress` of a stage -> what each body begins with, in the order of the bodies of the scene.  Complains of laws without an angle of friction where it asks for one.
std::vector<StartStress> start_stress_of_bodies(const K0Spec& spec, const Scene& scene, SceneErrorCollector& errors)
{
  std::vector<StartStress> all;
  for (const BodySpec& body : scene.bodies) {
    const K0Rule& rule = spec.of(body.name);
    Table& table = all.emplace_back(StartStress{.k0 = constant(rule.k0.value_or(1))}).k0;
    if (rule.stress)
      all.back().given = matrix_of(*rule.stress);
    if (!rule.k0_table.empty())
      table.points.clear();
    for (const std::vector<Real>& point : rule.k0_table)
      table.points.push_back({point.at(0), point.at(1)});
    const auto material = std::ranges::find(scene.materials, body.material, &MaterialSpec::name);
    if (!rule.from_friction || material == scene.materials.end())
      continue;
    const auto sine = std::visit([](const auto& law) { return sine_of_friction(law); }, choices_of(material->law));
    if (sine)
      table = constant(from_friction(*sine, rule.ocr));
    else
      errors.add(spec.where, "from_friction",
                 fmt::format("the law of body \"{}\" has no angle of friction; of the laws {} have one", body.name,
                             or_list(laws_with_friction())));
  }
  return all;
}

Stage stage_of(const RunSpec& spec)
{
  return {.duration = spec.duration, .damping = spec.damping, .holds_pore_pressure = spec.hold_pore_pressure, .where = spec.where};
}
Stage stage_of(const GeostaticSpec& spec)
{
  return {.duration = spec.duration,
          .damping = spec.damping,
          .ramp = spec.ramp,
          .ramp_shape = spec.ramp_shape,
          .elastic = spec.elastic,
          .residual = spec.residual,
          .start_stress = {},
          .reset_displacement = spec.reset_displacement,
          .where = spec.where};
}
Stage stage_of(const StaticSpec& spec)
{
  return {.duration = spec.duration,
          .elastic = spec.elastic,
          .equilibrium = EquilibriumOptions{.increments = spec.increments,
                                            .residual = spec.residual,
                                            .most_unbalanced = spec.unbalanced,
                                            .keeps_jump_stress = spec.keep_jump_stress,
                                            .most_iterations = spec.iterations,
                                            .most_cuts = spec.cuts},
          .start_stress = {},
          .reset_displacement = spec.reset_displacement,
          .where = spec.where};
}
Stage stage_of(const QuasiStaticSpec& spec)
{
  return {.duration = spec.duration,
          .elastic = spec.elastic,
          .equilibrium =
              EquilibriumOptions{
                  .increments = spec.increments, .residual = spec.residual, .most_iterations = spec.iterations, .most_cuts = spec.cuts},
          .start_stress = {},
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
    if (std::ranges::find(names, bodies[b].name) != names.end())
      numbers.push_back(static_cast<Index>(b));
  return numbers;
}

/// In words what becomes of the law of a body in a stage; empty if it stays what it is.
std::string renewal(const Scene& scene, const BodySpec& body, Index stage)
{
  if (!is_renewed(scene, body, stage))
    return {};
  const MaterialSpec &before = *material_of(scene, body, stage - 1), &after = *material_of(scene, body, stage);
  const Real weaker = weakened_by(scene, body, stage) / (&before == &after ? weakened_by(scene, body, stage - 1) : 1);
  const bool changes = &before != &after, weakens = weaker != 1 && has_strength(after);
  std::string text = changes ? fmt::format("goes on as \"{}\"", after.name) : "";
  if (weakens)
    text += fmt::format("{}has its strength divided by {:.6g}", changes ? " and " : "", weaker);
  return text;
}

/// How a new water table lies to the one before it, in words.  Of a table that something is wrong with there is nothing.
template <int D>
std::string moved_table(const Mesh<D>& mesh, const std::vector<Real>& before, const std::vector<Real>& after)
{
  if (after.empty() || before.size() != after.size())
    return "the water table changes";
  Real rise = 0, fall = 0;
  for (std::size_t n = 0; n < after.size(); ++n)
    rise = std::max(rise, after[n] - before[n]), fall = std::max(fall, before[n] - after[n]);
  if (rise == 0 && fall == 0)
    return fmt::format("the water table stays where it is, at all {} nodes", mesh.n_nodes());
  const std::string up = fmt::format("rises by up to {:.4g} m", rise), down = fmt::format("falls by up to {:.4g} m", fall);
  return fmt::format("the water table {}", fall == 0 ? up : rise == 0 ? down : up + " and " + down);
}

}  // namespace

template <int D>
void set_stages(const Scene& scene, SceneErrorCollector& errors, Setup<D>& setup)
{
  if (scene.stages.empty())
    setup.stages.push_back({.name = "run", .duration = scene.time.end, .where = scene.time.where});
  for (const StageSpec& spec : scene.stages)
    setup.stages.push_back(stage_of(spec));
  const auto has_table = [&](const std::string& name) {
    return std::ranges::any_of(scene.bodies, [&](const BodySpec& body) { return body.name == name && body.initial.has_value(); });
  };
  const bool any_table = std::ranges::any_of(scene.bodies, [](const BodySpec& body) { return body.initial.has_value(); });
  for (std::size_t s = 0; s < scene.stages.size(); ++s) {
    Stage& stage = setup.stages[s];
    const K0Spec* const stress = initial_stress_of(scene.stages[s]);
    if (const auto* solved = std::get_if<StaticSpec>(&scene.stages[s]);
        solved != nullptr && solved->grow.value_or(s == 0 && stress == nullptr && !any_table && !scene.initial)) {
      stage.ramp = stage.duration;
      if (s == 0 && (stress != nullptr || any_table || scene.initial))
        errors.add(
            stage.where, "grow",
            "the bodies begin with a stress, under which gravity and loads act from the beginning: leave grow out, or set it to false");
    }
    if (stress == nullptr)
      continue;
    stage.start_stress = start_stress_of_bodies(*stress, scene, errors);
    if (s > 0 || any_table) {
      std::vector<std::string> named;
      for (const BodySpec& body : scene.bodies)
        if (std::cmp_equal(presence_of(body.name, scene.stages).from, s) && !has_table(body.name))
          named.push_back(body.name);
      stage.start_stress_bodies = numbers_of(named, setup.state.bodies);
      if (named.empty())
        stage.start_stress.clear();
    }
    for (std::size_t b = 0; b < setup.state.bodies.size(); ++b) {
      const Index from = presence_of(setup.state.bodies[b].name, scene.stages).from;
      if (std::cmp_equal(from, s) && !has_table(setup.state.bodies[b].name) &&
          !setup.state.materials[b].law().description().starts_from_stress)
        errors.add(stage.where, "initial_stress",
                   fmt::format("law \"{}\" of body \"{}\" cannot start from a stress; leave initial_stress out and let gravity grow (ramp)",
                               setup.state.materials[b].law().name(), setup.state.bodies[b].name));
    }
  }
}

void check_laws(const Scene& scene, SceneErrorCollector& errors)
{
  const auto body_of = [&](const std::string& name) { return std::ranges::find(scene.bodies, name, &BodySpec::name); };
  for (std::size_t s = 0; s < scene.stages.size(); ++s) {
    const auto stage = static_cast<Index>(s);
    for (const NewMaterialSpec& change : changes_of(scene.stages[s]).change) {
      const MaterialSpec &before = *material_of(scene, *body_of(change.body), stage - 1),
                         &after = *material_of(scene, *body_of(change.body), stage);
      const auto name = [](const MaterialSpec& material) { return material.law.name(); };
      const auto can = laws_that_start_from_stress();
      if (name(before) != name(after) && std::ranges::find(can, name(after)) == can.end())
        errors.add(change.where, "material",
                   fmt::format("the body comes from law \"{}\", and law \"{}\" cannot start from its stress; of other laws {} can",
                               name(before), name(after), or_list(can)));
    }
    for (const WeakenSpec& weaken : changes_of(scene.stages[s]).weaken) {
      const bool found = std::ranges::any_of(scene.bodies, [&](const BodySpec& body) {
        return (weaken.body.empty() || body.name == weaken.body) && presence_of(body.name, scene.stages).in(stage) &&
               has_strength(*material_of(scene, body, stage));
      });
      if (!found)
        errors.add(weaken.where, weaken.body.empty() ? "" : "body",
                   weaken.body.empty() ? std::string("no body of this stage has a law with shear strength")
                                       : fmt::format("the law of body \"{}\" has no shear strength", weaken.body));
    }
  }
}

template <int D>
void check_room(const Scene& scene, const Mesh<D>& mesh, const Setup<D>& setup, Communicator& ranks, SceneErrorCollector& errors)
{
  CellOrder order;
  for (std::size_t s = 1; s < scene.stages.size(); ++s)
    for (const std::string& name : changes_of(scene.stages[s]).appear) {
      if (order.row.empty())
        sort_by_cell(setup.state.particles.cell, setup.state.particles.id, setup.state.bodies, mesh.n_cells(), order);
      const auto volumes = [&](const auto& chosen) {
        return volume_in_cells(mesh, setup.state.particles, order,
                               [&](Index b) { return chosen(setup.state.bodies[static_cast<std::size_t>(b)].name); });
      };
      const auto its = volumes([&](const std::string& body) { return body == name; });
      const auto there =
          volumes([&](const std::string& body) { return body != name && presence_of(body, scene.stages).in(static_cast<Index>(s)); });
      if (const Overlap<D> taken = overlap<D>(mesh, there, its, ranks); taken.share() > most_overlap)
        errors.add(where_of(scene.stages[s]), "appear", fmt::format("body \"{}\" cannot appear: {}", name, describe(taken)));
    }
}

template <int D>
void set_changes(const Scene& scene, const Mesh<D>& mesh, Communicator& ranks, Setup<D>& setup)
{
  const std::size_t n = setup.stages.size();
  setup.changes.resize(n);
  setup.laws = laws_of_stages(scene);
  for (const MaterialSpec& material : scene.materials)
    if (const auto law = material.law.model(); !law->library_digest().empty())
      setup.conditions.laws_of_user.push_back(law);
  const auto said = [&](std::size_t s) -> const StageChanges& { return changes_of(scene.stages[s]); };
  const bool bodies_differ = std::ranges::any_of(
      scene.stages, [](const StageSpec& stage) { return !changes_of(stage).appear.empty() || !changes_of(stage).vanish.empty(); });
  const bool walls_differ = bodies_differ || std::ranges::any_of(scene.boundaries, [](const BoundaryOptions& boundary) {
                              return !common_of(boundary).during.empty();
                            });
  const bool tables_differ = std::ranges::any_of(scene.stages, [](const StageSpec& stage) { return changes_of(stage).water.has_value(); });
  const auto names = wall_names(scene.boundaries);
  SceneErrorCollector errors(scene);
  for (std::size_t s = 1; s < n; ++s) {
    StageChange<D>& change = setup.changes[s];
    change.appear = numbers_of(said(s).appear, setup.state.bodies);
    change.vanish = numbers_of(said(s).vanish, setup.state.bodies);
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
      if (std::string becomes = renewal(scene, scene.bodies[b], static_cast<Index>(s)); !becomes.empty())
        change.renew.push_back({static_cast<Index>(b), std::move(becomes)});
    if (tables_differ)  // in every stage, so that a run that goes on in any of them finds the one that holds there
      change.table = setup.changes[s - 1].table ? setup.changes[s - 1].table : setup.conditions.water.table;
    if (!walls_differ && !said(s).water)
      continue;
    const auto there = [&](const std::string& body) { return presence_of(body, scene.stages).in(static_cast<Index>(s)); };
    const CellOccupancy<D> filled(mesh, setup.state.particles, setup.state.bodies, ranks, there);
    if (said(s).water) {
      change.table = table_of_stage(
          scene, *said(s).water, mesh, [&](Index cell) { return filled(cell); }, errors, setup.warnings);
      change.told.push_back(
          moved_table(mesh, setup.changes[s - 1].table ? *setup.changes[s - 1].table : setup.conditions.water.table, *change.table));
    }
    if (!walls_differ)
      continue;
    change.boundary.emplace();
    add_boundaries(scene, mesh, filled, ranks, said(s).label, false, errors, setup, *change.boundary);
    for (std::size_t w = 0; w < names.size(); ++w) {
      const bool acted = common_of(scene.boundaries[w]).acts_in(said(s - 1).label),
                 acts = common_of(scene.boundaries[w]).acts_in(said(s).label);
      if (acted != acts)
        change.told.push_back(fmt::format("wall \"{}\" {}", names[w], acts ? "acts from here on" : "is gone"));
    }
  }
  ranks.agree(Communicator::caught([&] { errors.throw_if_any(); }));
  for (std::size_t s = 1; s < n; ++s)
    if (!setup.changes[s].appear.empty()) {
      Water water = setup.conditions.water;
      water.table = setup.changes[s].table.value_or(water.table);
      saturate(scene, static_cast<Index>(s), mesh, water, setup.state.bodies, setup.state.particles);
    }
  for (std::size_t s = 1; s < n; ++s)
    if (!setup.changes[s].appear.empty())
      setup.changes[s].coming =
          extract_bodies<D>(setup.changes[s].appear, setup.state.bodies, setup.state.materials, setup.state.particles);
}

template void set_stages<2>(const Scene&, SceneErrorCollector&, Setup<2>&);
template void set_stages<3>(const Scene&, SceneErrorCollector&, Setup<3>&);
template void check_room<2>(const Scene&, const Mesh<2>&, const Setup<2>&, Communicator&, SceneErrorCollector&);
template void check_room<3>(const Scene&, const Mesh<3>&, const Setup<3>&, Communicator&, SceneErrorCollector&);
template void set_changes<2>(const Scene&, const Mesh<2>&, Communicator&, Setup<2>&);
template void set_changes<3>(const Scene&, const Mesh<3>&, Communicator&, Setup<3>&);

}  // namespace talus
