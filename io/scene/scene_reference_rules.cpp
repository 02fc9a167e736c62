// Rules about bodies that keep a reference configuration.
#include "io/scene/scene_rule_base.hpp"

namespace talus {

namespace {

class ReferenceRules : private SceneRuleBase {
 public:
  using SceneRuleBase::SceneRuleBase;

  std::vector<Finding> broken()
  {
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      const BodySpec& body = scene_.bodies[i];
      if (!body.reference || body.reference->update == ReferenceUpdate::always)
        continue;
      const std::string path = fmt::format("bodies[{}].reference", i);
      if (const auto sheet = std::ranges::find_if(scene_.rigid, &RigidSpec::is_sheet); sheet != scene_.rigid.end())
        add(path, fmt::format("the sides of the sheet \"{}\" are those of present positions: leave this out", sheet->name));
      if (const auto material = std::ranges::find(scene_.materials, body.material, &MaterialSpec::name);
          material != scene_.materials.end() && material->law.model()->heat())
        add(path, "heat is conducted between present positions: leave this out, or the conductivity");
      if (!body.reference->renews_in_parts())
        notices_no_contact(path, body);
    }
    return std::move(findings_);
  }

 private:
  /// Where the body is in the mesh does not follow its motion, so that it cannot touch anything later.
  void notices_no_contact(const std::string& path, const BodySpec& body)
  {
    const std::string advice = "; only `update: adaptive`, with a shift, knows where the body is";
    for (const BodySpec& other : scene_.bodies)
      if (other.name != body.name)
        add(path, fmt::format("body \"{}\" would not be touched where it is{}", other.name, advice));
    for (const RigidSpec& rigid : scene_.rigid)
      add(path, fmt::format("the rigid body \"{}\" would not be touched where it is{}", rigid.name, advice));
    for (std::size_t i = 0; i < scene_.boundaries.size(); ++i)
      if (has_dashpots(scene_.boundaries[i]) || std::holds_alternative<FrictionOptions>(scene_.boundaries[i]))
        add(path, fmt::format("the body would not run along boundaries[{}], or leave it{}", i, advice));
    if (scene_.water)
      add(path, fmt::format("water would press where the body was{}", advice));
  }
};

}  // namespace

std::vector<Finding> broken_reference_rules(const Scene& scene) { return ReferenceRules(scene).broken(); }

}  // namespace talus
