#include "io/output/scene_facts_json.hpp"

#include <nlohmann/json.hpp>

namespace talus {

namespace {

using FactsJson = nlohmann::ordered_json;

FactsJson law_object(const std::optional<FactsOfLaw>& law)
{
  if (!law)
    return {};
  return {{"material", law->material},
          {"law", law->law},
          {"has_strength", law->has_strength},
          {"strength_divided_by", law->strength_divided_by},
          {"variables", law->variables}};
}

FactsJson place_object(const SourceLocation& at) { return {{"file", at.file}, {"line", at.line}, {"column", at.column}, {"key", at.path}}; }

FactsJson body_object(const FactsOfBody& body, bool with_particles)
{
  FactsJson object{{"name", body.name}, {"where", place_object(body.where)}, {"stages", FactsJson::array()}};
  for (const std::optional<FactsOfLaw>& law : body.stages)
    object["stages"].push_back(law_object(law));
  if (with_particles)
    object.update(
        {{"particles", body.particles}, {"lowest [m]", body.lowest}, {"highest [m]", body.highest}, {"wave_speed [m/s]", body.wave_speed}});
  return object;
}

}  // namespace

std::string to_json(const SceneFacts& facts)
{
  FactsJson json;
  json["title"] = facts.title;
  json["dimension"] = facts.dimension;
  json["gravity [m/s^2]"] = facts.gravity;
  json["up"] = facts.up;
  if (facts.mesh)
    json["mesh"] = {{"cells", facts.mesh->cells}, {"nodes", facts.mesh->nodes}, {"digest", facts.mesh->digest}};
  json["stages"] = FactsJson::array();
  for (const SceneFacts::Stage& stage : facts.stages)
    json["stages"].push_back({{"name", stage.name}, {"type", stage.type}});
  json["bodies"] = FactsJson::array();
  for (const FactsOfBody& body : facts.bodies)
    json["bodies"].push_back(body_object(body, facts.mesh.has_value()));
  json["warnings"] = facts.warnings;
  json["scene"] = {{"file", facts.file}, {"digest", facts.digest}, {"set", facts.overrides}};
  json["where"] = FactsJson::array();
  for (const SourceLocation& block : facts.blocks)
    json["where"].push_back(place_object(block));
  json["keys"] = FactsJson::parse(facts.keys);
  return json.dump(2, ' ', false, FactsJson::error_handler_t::replace) + '\n';
}

}  // namespace talus
