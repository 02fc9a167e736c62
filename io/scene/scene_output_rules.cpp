// Rules of the block `outputs`: fields, columns and the names in them.
#include <map>

#include "core/field_component.hpp"
#include "io/output/history_columns.hpp"
#include "io/output/output_fields.hpp"
#include "io/scene/scene.hpp"
#include "io/scene/scene_rule_base.hpp"
#include "materials/interface/varied_law.hpp"

namespace talus {

namespace {

class OutputRules : private SceneRuleBase {
 public:
  using SceneRuleBase::SceneRuleBase;

  std::vector<Finding> broken()
  {
    outputs();
    return std::move(findings_);
  }

 private:
  void outputs()
  {
    const OutputSpec& outputs = scene_.outputs;
    const std::vector<ParticleField> of_particles = fields_of_particles();
    // Of a law whose library is not open no field is known.
    const bool all_known = std::ranges::all_of(scene_.materials, [](const MaterialSpec& one) { return one.law.is_open(); });
    if (outputs.particles && all_known)
      known_words("outputs.particles.fields", "field", outputs.particles->fields_wanted, names(of_particles));
    if (outputs.mesh)
      known_words("outputs.mesh.fields", "field", outputs.mesh->fields_wanted, names_of(node_fields()));
    if (all_known)
      picture(outputs.picture.field, of_particles);
    if (outputs.history)
      history(*outputs.history);
    if (outputs.runout)
      runout(*outputs.runout);
  }

  void runout(const RunoutSpec& runout)
  {
    const auto bodies = names(scene_.bodies);
    known_words("outputs.runout.bodies", "body", runout.bodies, bodies);
    known_words("outputs.runout.eroded", "body", runout.eroded, bodies);
    for (std::size_t i = 0; i < runout.eroded.size(); ++i)
      if (!runout.bodies.empty() && std::find(bodies.begin(), bodies.end(), runout.eroded[i]) != bodies.end() &&
          std::find(runout.bodies.begin(), runout.bodies.end(), runout.eroded[i]) == runout.bodies.end())
        add(fmt::format("outputs.runout.eroded[{}]", i), fmt::format("\"{}\" is not among outputs.runout.bodies", runout.eroded[i]));
    different_names("outputs.runout.sections", runout.sections);
    if (scene_.dimension == 2 && (runout.frames_every || runout.csv))
      add(runout.csv ? "outputs.runout.csv" : "outputs.runout.frames_every", "there are maps in 3 dimensions only");
    if (scene_.dimension == 2 && !runout.sections.empty())
      add("outputs.runout.sections", "there is one section in 2 dimensions, the plane itself, and it is always written: leave this out");
  }

  void history(const HistoryOutputSpec& history)
  {
    const auto bodies = names(scene_.bodies);
    different_names("outputs.history.points", history.points);
    different_names("outputs.history.fronts", history.fronts);
    different_names("outputs.history.moved", history.moved);
    for (std::size_t i = 0; i < history.points.size(); ++i) {
      const std::string path = fmt::format("outputs.history.points[{}]", i);
      fits(path + ".at", history.points[i].at);
      known_word(path + ".body", "body", history.points[i].body, bodies);
    }
    for (std::size_t i = 0; i < history.fronts.size(); ++i) {
      const std::string path = fmt::format("outputs.history.fronts[{}]", i);
      known_word(path + ".body", "body", history.fronts[i].body, bodies);
      const Direction direction = history.fronts[i].direction;
      if (scene_.dimension == 2 && (direction == Direction::z_plus || direction == Direction::z_minus))
        add(path + ".direction", "there is no z in 2 dimensions");
    }
    for (std::size_t i = 0; i < history.walls.size(); ++i) {
      const std::string path = fmt::format("outputs.history.walls[{}].on", i);
      known_word(path, "wall", history.walls[i].on, wall_names(scene_.boundaries));
      for (std::size_t j = 0; j < i; ++j)
        if (!history.walls[i].on.empty() && history.walls[j].on == history.walls[i].on)
          add(path, fmt::format("\"{}\" is asked for by outputs.history.walls[{}] already", history.walls[i].on, j));
    }
    for (std::size_t i = 0; i < history.moved.size(); ++i)
      known_word(fmt::format("outputs.history.moved[{}].body", i), "body", history.moved[i].body, bodies);
    known_words("outputs.history.bodies", "body", history.bodies, bodies);
    if (scene_.dimension == 2 || scene_.dimension == 3)
      different_columns(history);
  }

  /// Two columns must not have the same name, because programs read such tables differently.
  void different_columns(const HistoryOutputSpec& history)
  {
    std::map<std::string, std::string> giver;  // the entry that adds each column
    const auto note = [&](const std::string& path, std::string_view key, const std::string& name, const std::vector<CsvColumn>& columns) {
      bool told = name.empty();
      for (const CsvColumn& column : columns) {
        const auto [known, is_new] = giver.try_emplace(column.name, path);
        if (!is_new && !told)
          add(fmt::format("{}.{}", path, key),
              fmt::format("its column \"{}\" of history.csv is there already: {} has it", column.name, known->second));
        told = told || !is_new;
      }
    };
    const auto columns = [&](const auto& table, const std::string& owner) { return csv_columns(table, owner, scene_.dimension); };
    note("every history", "", "", columns(run_columns(), ""));
    const auto walls = wall_names(scene_.boundaries);
    for (std::size_t i = 0; i < walls.size(); ++i)
      note(fmt::format("boundaries[{}]", i), "on", walls[i], columns(reaction_columns(), walls[i]));
    for (std::size_t i = 0; i < history.points.size(); ++i)
      if (const PointSpec& point = history.points[i]; is_first(history.points, i)) {
        const std::string path = fmt::format("outputs.history.points[{}]", i);
        note(path, "name", point.name, columns(point_columns(), point.name));
        if (scene_.water && scene_.water->flow)
          note(path, "name", point.name, columns(point_water_columns(), point.name));
      }
    for (std::size_t i = 0; i < history.fronts.size(); ++i)
      if (const FrontSpec& front = history.fronts[i]; is_first(history.fronts, i))
        note(fmt::format("outputs.history.fronts[{}]", i), "name", front.name, columns(front_columns(), front.name));
    for (std::size_t i = 0; i < history.walls.size(); ++i)
      if (const WallSpec& wall = history.walls[i];
          std::none_of(history.walls.begin(), history.walls.begin() + static_cast<std::ptrdiff_t>(i),
                       [&](const WallSpec& earlier) { return earlier.on == wall.on; }))
        note(fmt::format("outputs.history.walls[{}]", i), "on", wall.on, columns(wall_columns(), wall.on));
    for (std::size_t i = 0; i < history.moved.size(); ++i)
      if (const MovedSpec& moved = history.moved[i]; is_first(history.moved, i))
        note(fmt::format("outputs.history.moved[{}]", i), "name", moved.name, columns(moved_columns(), moved.name));
    for (std::size_t i = 0; i < history.bodies.size(); ++i)
      if (std::find(history.bodies.begin(), history.bodies.begin() + static_cast<std::ptrdiff_t>(i), history.bodies[i]) ==
          history.bodies.begin() + static_cast<std::ptrdiff_t>(i))
        note("outputs.history", fmt::format("bodies[{}]", i), history.bodies[i], columns(body_columns(), history.bodies[i]));
  }

  /// Checks an entry against others of its name; different names are checked by different_names().
  template <class Item>
  static bool is_first(const std::vector<Item>& items, std::size_t i)
  {
    return std::none_of(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(i),
                        [&](const Item& item) { return item.name == items[i].name; });
  }

  struct ParticleField {
    std::string name;
    int components;
  };

  /// The fields of every particle, and the history variables of the laws of bodies, also of laws that bodies get in later stages.
  std::vector<ParticleField> fields_of_particles() const
  {
    std::vector<ParticleField> known;
    for_each_quantity(particle_fields(), [&](const auto& field) { known.push_back({std::string(field.name), components_of(field.kind)}); });
    const std::vector<std::string> used = used_materials(), there = names(scene_.materials);
    const auto among = [](const auto& list) {
      return [&list](const std::string& name) { return std::find(list.begin(), list.end(), name) != list.end(); };
    };
    const bool misspelt = !std::all_of(used.begin(), used.end(), among(there));  // any of them may be meant
    for (const MaterialSpec& material : scene_.materials)
      if (misspelt || among(used)(material.name))
        for (const HistoryVariable& variable : material.law.description().variables)
          known.push_back({std::string(variable.key), variable.components});
    for (const MaterialSpec& material : scene_.materials)
      if (misspelt || among(used)(material.name))
        for (const ParameterVariation& one : material.variation)
          known.push_back({name_of_factor(one.parameter), 1});
    return known;
  }

  std::vector<std::string> used_materials() const
  {
    std::vector<std::string> used;
    for (const BodySpec& body : scene_.bodies)
      used.push_back(body.material);
    for (const StageSpec& stage : scene_.stages)
      for (const auto& change : changes_of(stage).change)
        used.push_back(change.material);
    return used;
  }

  /// Checks the field of pictures, which may name a component: "velocity:x".
  void picture(const std::string& asked, const std::vector<ParticleField>& known)
  {
    const ViewedField shown = ViewedField::of(asked);
    if (!known_word("outputs.picture.field", "field", shown.name, names(known)))
      return;
    const auto field = std::find_if(known.begin(), known.end(), [&](const ParticleField& one) { return one.name == shown.name; });
    try {
      shown.component_of(field->components);
    } catch (const Error& wrong) {
      add("outputs.picture.field", wrong.what());
    }
  }
};

}  // namespace

std::vector<Finding> broken_output_rules(const Scene& scene) { return OutputRules(scene).broken(); }

}  // namespace talus
