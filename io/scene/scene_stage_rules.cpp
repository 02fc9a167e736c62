// Rules for changes by stages: which bodies are present, what happens to them, which walls act.
#include <map>

#include "io/scene/scene_rule_base.hpp"
#include "materials/interface/law_variant.hpp"

namespace talus {

namespace {

bool suspends_yielding(const StageSpec& stage)
{
  return std::visit(
      []<class S>(const S& spec) {
        if constexpr (requires { spec.elastic; })
          return spec.elastic;
        else
          return false;
      },
      stage);
}

class StageRules : private SceneRuleBase {
 public:
  explicit StageRules(const Scene& scene) : SceneRuleBase(scene), bodies_(names(scene.bodies)), materials_(names(scene.materials)) {}

  std::vector<Finding> broken()
  {
    stage_names();
    for (std::size_t s = 0; s < scene_.stages.size(); ++s)
      stage(static_cast<Index>(s));
    boundaries();
    return std::move(findings_);
  }

 private:
  /// The name of a stage in messages, such as "stages[1] \"fill\"".
  std::string said(Index s) const
  {
    const std::string& label = changes_of(scene_.stages[static_cast<std::size_t>(s)]).label;
    return fmt::format("stages[{}]{}", s, label.empty() ? "" : fmt::format(" \"{}\"", label));
  }

  void stage_names()
  {
    std::map<std::string, std::size_t> first;
    for (std::size_t s = 0; s < scene_.stages.size(); ++s)
      if (const std::string& label = changes_of(scene_.stages[s]).label; !label.empty())
        if (const auto [known, is_new] = first.try_emplace(label, s); !is_new)
          add(fmt::format("stages[{}].name", s), fmt::format("\"{}\" is the name of stages[{}] already", label, known->second));
  }

  void stage(Index s)
  {
    const StageChanges& changes = changes_of(scene_.stages[static_cast<std::size_t>(s)]);
    const std::string at = fmt::format("stages[{}]", s);
    if (is_solved(scene_.stages[static_cast<std::size_t>(s)]))
      solved(at);
    if (const auto* run = std::get_if<RunSpec>(&scene_.stages[static_cast<std::size_t>(s)]);
        run != nullptr && run->hold_pore_pressure && !(scene_.water && scene_.water->flow))
      add(at + ".hold_pore_pressure", "no water flows in this scene, whose pressures could be held: leave this out, or give water.flow");
    if (suspends_yielding(scene_.stages[static_cast<std::size_t>(s)]))
      knows_no_suspension(at + ".elastic");
    for (std::size_t i = 0; i < changes.appear.size(); ++i)
      appears(fmt::format("{}.appear[{}]", at, i), changes.appear[i], s, i);
    for (std::size_t i = 0; i < changes.vanish.size(); ++i)
      vanishes(fmt::format("{}.vanish[{}]", at, i), changes.vanish[i], s, i);
    for (std::size_t i = 0; i < changes.change.size(); ++i) {
      const auto& [body, material, where] = changes.change[i];
      const std::string path = fmt::format("{}.change[{}]", at, i);
      known_word(path + ".material", "material", material, materials_);
      if (known_word(path + ".body", "body", body, bodies_) && is_there(path + ".body", body, s))
        begins_elsewhere(path, body, s);
      for (std::size_t j = 0; j < i; ++j)
        if (!body.empty() && changes.change[j].body == body)
          add(path + ".body", fmt::format("\"{}\" changes by change[{}] already", body, j));
    }
    for (std::size_t i = 0; i < changes.weaken.size(); ++i) {
      const std::string path = fmt::format("{}.weaken[{}].body", at, i);
      if (const std::string& body = changes.weaken[i].body; known_word(path, "body", body, bodies_))
        is_there(path, body, s);
    }
    if (changes.water && s == 0)
      add(at + ".water", "the first stage has the table of the block water of the scene: give it there");
    else if (changes.water && !scene_.water)
      add(at + ".water",
          "there is no water in this scene: its block water says how heavy it is, which bodies are drained, and where its "
          "table is at the start");
    else if (changes.water && scene_.water->flow)
      add(at + ".water", "where water flows, its pressure follows from its boundaries: give water.flow.heads with a table in time");
    const bool any_left = std::ranges::any_of(bodies_, [&](const std::string& body) { return presence(body).in(s); });
    const bool any_before = s == 0 || std::ranges::any_of(bodies_, [&](const auto& body) { return presence(body).in(s - 1); });
    if (!bodies_.empty() && !any_left && any_before)
      add(at, s == 0 ? "there is no body at the start: all of them appear later" : "no body is left in this stage");
  }

  /// A stage without inertia has one field of displacements, and boundaries of the mesh.
  void solved(const std::string& at)
  {
    const auto refuse = [&](bool there, std::string_view key) {
      if (there)
        add(at, fmt::format("a stage that solves for equilibrium has no {}: let a stage of type geostatic find it", key));
    };
    refuse(!scene_.contacts.empty(), "contacts");
    refuse(!scene_.cuts.empty(), "cuts");
    refuse(!scene_.rigid.empty(), "rigid bodies");
  }

  void knows_no_suspension(const std::string& path)
  {
    for (const MaterialSpec& material : scene_.materials)
      if (std::holds_alternative<UmatLaw>(choices_of(material.law)))
        add(path, fmt::format("the subroutine of material \"{}\" cannot suspend yielding: give elastic: false, with which "
                              "it yields",
                              material.name));
  }

  void appears(const std::string& path, const std::string& body, Index s, std::size_t place)
  {
    if (!known_word(path, "body", body, bodies_))
      return;
    if (const auto earlier = named_before(&StageChanges::appear, body, s, place))
      add(path, fmt::format("\"{}\" appears in {} already", body, said(*earlier)));
    else if (s == 0)
      add(path, fmt::format("\"{}\" is there from the first stage on without being named here: leave it out", body));
  }

  void vanishes(const std::string& path, const std::string& body, Index s, std::size_t place)
  {
    if (!known_word(path, "body", body, bodies_))
      return;
    const Presence there = presence(body);
    if (const auto earlier = named_before(&StageChanges::vanish, body, s, place))
      add(path, fmt::format("\"{}\" vanishes in {} already", body, said(*earlier)));
    else if (s == 0)
      add(path, fmt::format("\"{}\" would never be there: leave the body out", body));
    else if (there.from >= s)
      add(path, fmt::format("\"{}\" vanishes before it is there: it appears in {}", body, said(there.from)));
  }

  bool is_there(const std::string& path, const std::string& body, Index s)
  {
    const Presence there = presence(body);
    if (s < there.from)
      add(path, fmt::format("\"{}\" is not there yet: it appears in {}", body, said(there.from)));
    else if (s >= there.until)
      add(path, fmt::format("\"{}\" is not there any more: it vanishes in {}", body, said(there.until)));
    return there.in(s);
  }

  /// A body that appears in a stage should be given its material directly.
  void begins_elsewhere(const std::string& path, const std::string& body, Index s)
  {
    if (presence(body).from == s)
      add(path, fmt::format("\"{}\" begins in this stage: give it the material in bodies", body));
  }

  void boundaries()
  {
    std::vector<std::string> names;
    for (const StageSpec& stage : scene_.stages)
      if (const std::string& label = changes_of(stage).label; !label.empty())
        names.push_back(label);
    for (std::size_t b = 0; b < scene_.boundaries.size(); ++b) {
      const auto& during = common_of(scene_.boundaries[b]).during;
      for (std::size_t i = 0; i < during.size(); ++i) {
        const std::string path = fmt::format("boundaries[{}].during[{}]", b, i);
        if (names.empty())
          add(path, fmt::format("there is no stage \"{}\": no stage has a name", during[i]));
        else
          known_word(path, "stage", during[i], names);
      }
    }
  }

  Presence presence(const std::string& body) const { return presence_of(body, scene_.stages); }

  /// The earlier stage that names the body, before that position in the list of stage `s`.
  std::optional<Index> named_before(std::vector<std::string> StageChanges::*list, const std::string& body, Index s, std::size_t place) const
  {
    for (Index t = 0; t <= s; ++t) {
      const auto& names = changes_of(scene_.stages[static_cast<std::size_t>(t)]).*list;
      const auto found = std::ranges::find(names, body);
      if (found != names.end() && (t < s || static_cast<std::size_t>(found - names.begin()) < place))
        return t;
    }
    return std::nullopt;
  }

  std::vector<std::string> bodies_, materials_;
};

}  // namespace

std::vector<Finding> broken_stage_rules(const Scene& scene) { return StageRules(scene).broken(); }

}  // namespace talus
