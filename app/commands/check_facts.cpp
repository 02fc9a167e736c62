// The command talus check --json.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "app/commands/check_command.hpp"
#include "app/run/summary.hpp"
#include "app/setup/laws_in_force.hpp"
#include "app/setup/setup.hpp"
#include "io/load_mesh.hpp"
#include "io/output/scene_facts_json.hpp"
#include "io/scene/reader.hpp"
#include "mesh/digest.hpp"

namespace talus {

namespace {

std::string type_of(const StageSpec& stage)
{
  return std::visit([]<class Spec>(const Spec&) { return std::string(Spec::name); }, stage);
}

FactsOfLaw law_of(const Scene& scene, const BodySpec& body, Index stage)
{
  const MaterialSpec& material = *material_of(scene, body, stage);
  FactsOfLaw facts{.material = material.name,
                   .law = std::string(material.law.name()),
                   .has_strength = has_strength(material),
                   .strength_divided_by = weakened_by(scene, body, stage)};
  for (const HistoryVariable& variable : material.law.description().variables)
    if (variable.components == 1)
      facts.variables.emplace_back(variable.key);
  return facts;
}

FactsOfBody body_of(const Scene& scene, const BodySpec& body)
{
  FactsOfBody facts{.name = body.name, .where = body.where, .stages = {}};
  const Presence presence = presence_of(body.name, scene.stages);
  const auto stages = std::max<Index>(1, static_cast<Index>(scene.stages.size()));
  for (Index stage = 0; stage < stages; ++stage)
    facts.stages.push_back(presence.in(stage) ? std::optional(law_of(scene, body, stage)) : std::nullopt);
  return facts;
}

SceneFacts facts_of(const Scene& scene)
{
  SceneFacts facts;
  facts.file = scene.file, facts.title = scene.title, facts.digest = scene_digest(scene), facts.overrides = scene.overrides;
  facts.keys = keys_as_json(scene.file, scene.overrides);
  facts.dimension = scene.dimension;
  for (const LoadSpec& load : scene.loads)
    if (const auto* gravity = std::get_if<GravitySpec>(&load))
      facts.gravity = Eigen::Map<const Eigen::VectorXd>(gravity->acceleration.data(), std::ssize(gravity->acceleration)).norm();
  const Vec3 up = upright_of(scene);
  facts.up = {up.x(), up.y(), up.z()};
  for (const StageSpec& stage : scene.stages)
    facts.stages.push_back({.name = name_of(stage), .type = type_of(stage)});
  for (const BodySpec& body : scene.bodies)
    facts.bodies.push_back(body_of(scene, body));
  const auto add_block = [&](SourceLocation where, const char* key) {
    where.path = key;
    facts.blocks.push_back(std::move(where));
  };
  add_block(scene.mesh.where, "mesh");
  if (scene.initial)
    add_block(scene.initial->where, "initial");
  return facts;
}

/// Adds the particles of a body, at some positions [m].
template <class Positions, class Direction>
void add_rows(const Body& body, const Positions& x, const Direction& up, FactsOfBody& facts)
{
  for (Index row = body.begin; row < body.end; ++row) {
    const Real at = up.dot(x[static_cast<std::size_t>(row)]);
    facts.lowest = facts.particles == 0 ? at : std::min(facts.lowest, at);
    facts.highest = facts.particles == 0 ? at : std::max(facts.highest, at);
    ++facts.particles;
  }
}

/// Makes the mesh and the model of the scene.
template <int D>
void add_model(const Scene& scene, SceneFacts& facts)
{
  const Mesh<D> mesh = load_mesh<D>(scene, folder_of(scene));
  const Setup<D> setup = set_up(scene, mesh);
  facts.mesh = FactsOfMesh{.cells = mesh.n_cells(), .nodes = mesh.n_nodes(), .digest = digest_text(digest(mesh))};
  facts.warnings = setup.warnings;
  const Vec<D> up = upright_of(scene).template head<D>();
  for (std::size_t b = 0; b < facts.bodies.size(); ++b) {
    facts.bodies[b].wave_speed = setup.state.materials[b].law().wave_speed(Mat3::Identity());
    add_rows(setup.state.bodies[b], setup.state.particles.x, up, facts.bodies[b]);
    for (const StageChange<D>& change : setup.changes)
      if (std::ranges::find(change.appear, static_cast<Index>(b)) != change.appear.end())
        add_rows(change.coming.bodies[b], change.coming.particles.x, up, facts.bodies[b]);
  }
}

}  // namespace

void check_as_json(const std::filesystem::path& file, const std::vector<std::string>& set, bool keys_only)
{
  const Scene scene = read_scene(file, set);
  SceneFacts facts = facts_of(scene);
  if (!keys_only && scene.dimension == 2)
    add_model<2>(scene, facts);
  else if (!keys_only)
    add_model<3>(scene, facts);
  fmt::print("{}", to_json(facts));
}

}  // namespace talus
