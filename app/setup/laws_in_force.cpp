#include "app/setup/laws_in_force.hpp"

#include <algorithm>

#include "materials/interface/varied_law.hpp"

namespace talus {

namespace {

/// The material that a stage gives to the body; empty if it keeps what it has.
std::string given_in(const StageSpec& stage, const std::string& body)
{
  for (const NewMaterialSpec& change : changes_of(stage).change)
    if (change.body == body)
      return change.material;
  return {};
}

/// The last stage up to `stage` that gives the body a material.
std::optional<std::size_t> last_change(const Scene& scene, const BodySpec& body, Index stage)
{
  for (std::size_t s = std::min(static_cast<std::size_t>(stage) + 1, scene.stages.size()); s-- > 0;)
    if (!given_in(scene.stages[s], body.name).empty())
      return s;
  return std::nullopt;
}

/// Names those with which the body, as it is in a stage, is averaged as one.  It is the same in all stages until the body is renewed.
Index group_of_averages(const Scene& scene, const BodySpec& body, const MaterialSpec& material, Index stage)
{
  Index since = presence_of(body.name, scene.stages).from;
  for (Index s = since + 1; s <= stage; ++s)
    if (is_renewed(scene, body, s))
      since = s;
  const auto number = static_cast<Index>(&material - scene.materials.data()), stages = static_cast<Index>(scene.stages.size()) + 1;
  return 2 * (number * stages + since) + (body.fills() ? 1 : 0);
}

}  // namespace

const MaterialSpec* material_of(const Scene& scene, const BodySpec& body, Index stage)
{
  const auto changed = last_change(scene, body, stage);
  const std::string name = changed ? given_in(scene.stages[*changed], body.name) : body.material;
  const auto found = std::find_if(scene.materials.begin(), scene.materials.end(), [&](const MaterialSpec& m) { return m.name == name; });
  return found == scene.materials.end() ? nullptr : &*found;
}

Real weakened_by(const Scene& scene, const BodySpec& body, Index stage)
{
  const Presence there = presence_of(body.name, scene.stages);
  Real factor = 1;
  for (std::size_t s = last_change(scene, body, stage).value_or(0); s < scene.stages.size() && std::cmp_less_equal(s, stage); ++s)
    for (const WeakenSpec& weaken : changes_of(scene.stages[s]).weaken)
      if (there.in(static_cast<Index>(s)) && (weaken.body.empty() || weaken.body == body.name))
        factor *= weaken.factor;
  return factor;
}

bool has_strength(const MaterialSpec& material) { return material.law.description().has_strength; }

bool is_renewed(const Scene& scene, const BodySpec& body, Index stage)
{
  if (stage == 0 || !presence_of(body.name, scene.stages).in(stage - 1))
    return false;
  const MaterialSpec &before = *material_of(scene, body, stage - 1), &after = *material_of(scene, body, stage);
  return &before != &after || (has_strength(after) && weakened_by(scene, body, stage) != weakened_by(scene, body, stage - 1));
}

Material law_in_force(const Scene& scene, const BodySpec& body, Index stage)
{
  const MaterialSpec& spec = *material_of(scene, body, stage);
  Material material(varied_law(spec.law, spec.variation), 0, 0, spec.name, spec.where);
  if (const Real factor = weakened_by(scene, body, stage); factor != 1)
    material.weaken(factor);
  material.viscosity = spec.bulk_viscosity;
  material.averages_volume = body.f_bar.value_or(material.law().description().is_isochoric);
  material.kind = static_cast<Index>(&spec - scene.materials.data());
  material.group = group_of_averages(scene, body, spec, stage);
  return material;
}

std::vector<std::vector<Material>> laws_of_stages(const Scene& scene)
{
  std::vector<std::vector<Material>> laws(std::max(scene.stages.size(), std::size_t{1}));
  for (std::size_t s = 0; s < laws.size(); ++s)
    for (const BodySpec& body : scene.bodies)
      laws[s].push_back(law_in_force(scene, body, std::max(static_cast<Index>(s), presence_of(body.name, scene.stages).from)));
  return laws;
}

}  // namespace talus
