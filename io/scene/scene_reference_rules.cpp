// Rules about bodies that keep a reference configuration, and about those whose particles are split.
#include "io/scene/scene_rule_base.hpp"

namespace talus {

namespace {

class ReferenceRules : private SceneRuleBase {
 public:
  using SceneRuleBase::SceneRuleBase;

  std::vector<Finding> broken()
  {
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i)
      if (scene_.bodies[i].resample)
        resample(scene_.bodies[i], fmt::format("bodies[{}].resample", i));
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      const BodySpec& body = scene_.bodies[i];
      if (!body.reference || body.reference->update == ReferenceUpdate::always)
        continue;
      const std::string path = fmt::format("bodies[{}].reference", i);
      if (const auto sheet = std::ranges::find_if(scene_.rigid, &RigidSpec::is_sheet); sheet != scene_.rigid.end())
        add(path, fmt::format("the sides of the sheet \"{}\" are those of present positions: leave this out", sheet->name));
      if (has_law(body, [](const ConstitutiveLaw& law) { return law.heat().has_value(); }))
        add(path, "heat is conducted between present positions: leave this out, or the conductivity");
      if (has_law(body, [](const ConstitutiveLaw& law) { return law.strain_averaging().has_value(); }))
        add(path, "plastic strain is averaged between present positions: leave this out, or the softening_length");
      if (scene_.water && scene_.water->flow)
        add(path, "water flows between present positions: leave this out, or water.flow");
      if (body.reference->update == ReferenceUpdate::never)
        for (const std::string& contact : contacts_of_body(scene_, body))
          add(path + ".update", fmt::format("{}; only `adaptive` knows where the body is", contact));
    }
    return std::move(findings_);
  }

 private:
  void resample(const BodySpec& body, const std::string& path)
  {
    if (body.reference && body.reference->update != ReferenceUpdate::always)
      add(path, "its reference configuration is that of whole particles: leave this out, or the reference");
    if (const auto sheet = std::ranges::find_if(scene_.rigid, &RigidSpec::is_sheet); sheet != scene_.rigid.end())
      add(path, fmt::format("half of a particle could come to the other side of the sheet \"{}\": leave this out", sheet->name));
    if (has_law(body, keeps_failure))
      add(path, "merged with what is intact, what has failed would carry loads again: leave this out, or take a law without failure");
    if (!scene_.cuts.empty())
      add(path, fmt::format("half of a particle could come to the other side of the cut \"{}\": leave this out", scene_.cuts.front().on));
  }
  /// Whether a law remembers that it has failed.
  static bool keeps_failure(const ConstitutiveLaw& law)
  {
    return std::ranges::any_of(law.variables(),
                               [](const HistoryVariable& one) { return one.key == "damage" || one.key == "porosity_gain"; });
  }
  /// Whether a body has a material whose law does something, at the start or from a stage on.
  bool has_law(const BodySpec& body, bool (*does_it)(const ConstitutiveLaw&)) const
  {
    const auto does = [&](const std::string& name) {
      const auto material = std::ranges::find(scene_.materials, name, &MaterialSpec::name);
      return material != scene_.materials.end() && material->law.is_open() && does_it(*material->law.model());
    };
    return does(body.material) || std::ranges::any_of(scene_.stages, [&](const StageSpec& stage) {
             return std::ranges::any_of(changes_of(stage).change,
                                        [&](const NewMaterialSpec& change) { return change.body == body.name && does(change.material); });
           });
  }
};

}  // namespace

std::vector<std::string> contacts_of_body(const Scene& scene, const BodySpec& body)
{
  std::vector<std::string> all;
  for (const BodySpec& other : scene.bodies)
    if (other.name != body.name)
      all.push_back(fmt::format("body \"{}\" would not be touched where it is", other.name));
  for (const RigidSpec& rigid : scene.rigid)
    all.push_back(fmt::format("the rigid body \"{}\" would not be touched where it is", rigid.name));
  for (std::size_t i = 0; i < scene.boundaries.size(); ++i)
    if (has_dashpots(scene.boundaries[i]) || std::holds_alternative<FrictionOptions>(scene.boundaries[i]))
      all.push_back(fmt::format("the body would not run along boundaries[{}], or leave it", i));
  if (scene.water)
    all.emplace_back("water would press where the body was");
  return all;
}

std::vector<Finding> broken_reference_rules(const Scene& scene) { return ReferenceRules(scene).broken(); }

}  // namespace talus
