#include "io/scene/scene_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/word_match.hpp"
#include "io/document/key_aliases.hpp"
#include "io/scene/history_columns.hpp"
#include "kernels/kernels.hpp"

namespace talus {

namespace {

class Rules {
 public:
  explicit Rules(const Scene& scene) : scene_(scene) {}

  std::vector<Finding> broken()
  {
    kernel();
    mesh();
    time();
    materials_and_bodies();
    loads_and_boundaries();
    outputs();
    const auto of_stages = broken_stage_rules(scene_);
    findings_.insert(findings_.end(), of_stages.begin(), of_stages.end());
    return std::move(findings_);
  }

 private:
  void kernel()
  {
    if (const std::string_view removed = removed_choice(scene_.kernel); !removed.empty())
      add("kernel", fmt::format("there is no kernel \"{}\": {}", scene_.kernel, removed));
    else
      known_word("kernel", "kernel", scene_.kernel, kernel_names());
    const auto only_of = [&](std::string_view kernel, bool given) {
      if (given && scene_.kernel != kernel)
        add(std::string(kernel), fmt::format("these are choices of the kernel {}; the scene's is {}", kernel, scene_.kernel));
    };
    only_of("umls", scene_.umls.has_value());
    only_of("projected", scene_.projected.has_value());
    if (scene_.kernel == "projected" && scene_.transfer.scheme == TransferScheme::apic)
      add("transfer.scheme", "apic takes its matrix from the weights of particles, which projected does not make; take tpic or aflip");
  }

  void add(std::string path, std::string message) { findings_.push_back({std::move(path), std::move(message)}); }

  void known_word(std::string path, std::string_view what, const std::string& word, const std::vector<std::string>& known)
  {
    if (!word.empty() && std::find(known.begin(), known.end(), word) == known.end())
      add(std::move(path), fmt::format("there is no {} \"{}\"{}", what, word, suggestion(word, known)));
  }

  template <class Item>
  static std::vector<std::string> names(const std::vector<Item>& items)
  {
    std::vector<std::string> all;
    for (const Item& item : items)
      all.push_back(item.name);
    return all;
  }

  template <class Item>
  void different_names(const std::string& path, const std::vector<Item>& items)
  {
    const auto all = names(items);
    for (auto name = all.begin(); name != all.end(); ++name)
      if (const auto first = std::find(all.begin(), name, *name); first != name && !name->empty())
        add(fmt::format("{}[{}].name", path, name - all.begin()),
            fmt::format("\"{}\" is the name of {}[{}] already", *name, path, first - all.begin()));
  }

  /// A list with one entry per dimension, unless it is empty.
  template <class T>
  void fits(const std::string& path, const std::vector<T>& list)
  {
    if (scene_.dimension != 0 && !list.empty() && list.size() != static_cast<std::size_t>(scene_.dimension))
      add(path, fmt::format("needs {} values in {} dimensions, not {}", scene_.dimension, scene_.dimension, list.size()));
  }
  void fits(const std::string& path, const Box& box)
  {
    fits(path + ".low", box.low);
    fits(path + ".high", box.high);
  }
  void fits(const std::string& path, const Sphere& sphere) { fits(path + ".centre", sphere.centre); }
  void fits(const std::string& path, const Cylinder& cylinder)
  {
    if (scene_.dimension == 2)
      return add(path + ".type", "a cylinder needs 3 dimensions; in 2 use a sphere or a box");
    fits(path + ".from", cylinder.from);
    fits(path + ".to", cylinder.to);
  }
  void fits(const std::string& path, const Polygon& polygon)
  {
    if (scene_.dimension == 3 && polygon.extrude.empty() && !polygon.points.empty())
      add(path, "missing key \"extrude\" [m]: in 3 dimensions a polygon has [z from, z to]");
    if (scene_.dimension == 2 && !polygon.extrude.empty())
      add(path + ".extrude", "a polygon is extruded in 3 dimensions only");
  }
  void fits(const std::string& path, const Ring& ring) { fits(path + ".centre", ring.centre); }
  void fits(const std::string& path, const SimpleShape& shape)
  {
    std::visit([&](const auto& s) { fits(path, s); }, shape);
  }
  void fits_all(const std::string& path, const std::vector<SimpleShape>& parts)
  {
    for (std::size_t i = 0; i < parts.size(); ++i)
      fits(fmt::format("{}[{}]", path, i), parts[i]);
  }
  void fits(const std::string& path, const Difference& difference)
  {
    fits(path + ".of", difference.of);
    fits_all(path + ".without", difference.without);
  }
  void fits(const std::string& path, const Union& all) { fits_all(path + ".of", all.of); }
  void fits(const std::string& path, const Intersection& all) { fits_all(path + ".of", all.of); }
  void fits(const std::string& path, const Shape& shape)
  {
    std::visit([&](const auto& s) { fits(path, s); }, shape);
  }

  void mesh()
  {
    const MeshSpec& mesh = scene_.mesh;
    different_names("mesh.regions", mesh.regions);
    different_names("mesh.groups", mesh.groups);
    for (std::size_t i = 0; i < mesh.regions.size(); ++i)
      fits(fmt::format("mesh.regions[{}].shape", i), mesh.regions[i].shape);
    for (std::size_t i = 0; i < mesh.refine.size(); ++i)
      fits(fmt::format("mesh.refine[{}].within", i), mesh.refine[i].within);
    for (std::size_t i = 0; i < mesh.groups.size(); ++i) {
      if (mesh.groups[i].within)
        fits(fmt::format("mesh.groups[{}].within", i), *mesh.groups[i].within);
      fits(fmt::format("mesh.groups[{}].facing", i), mesh.groups[i].facing);
      static constexpr std::array<std::string_view, 7> taken{"x_min", "x_max", "y_min", "y_max", "z_min", "z_max", "boundary"};
      if (std::find(taken.begin(), taken.end(), mesh.groups[i].name) != taken.end())
        add(fmt::format("mesh.groups[{}].name", i), fmt::format("every mesh has a group \"{}\" already", mesh.groups[i].name));
    }
    if (mesh.grid) {
      fits("mesh.grid.low", mesh.grid->low);
      fits("mesh.grid.high", mesh.grid->high);
      fits("mesh.grid.cells", mesh.grid->cells);
    }
    if (mesh.terrain)
      terrain(*mesh.terrain);
  }

  void terrain(const TerrainSpec& terrain)
  {
    if (terrain.section && scene_.dimension == 3)
      add("mesh.terrain.section", "a section is the plan of a scene of dimension 2");
    different_names("mesh.terrain.layers", terrain.layers);
    different_names("mesh.terrain.obstacles", terrain.obstacles);
    const auto layers = names(terrain.layers);
    for (std::size_t i = 0; i < terrain.refine.size(); ++i)
      known_word(fmt::format("mesh.terrain.refine[{}].down_from", i), "layer", terrain.refine[i].down_from, layers);
    if (!terrain.air)
      return;
    known_word("mesh.terrain.air.of", "layer", terrain.air->of, layers);
    for (std::size_t i = 0; i < terrain.obstacles.size(); ++i)
      if (const Real height = terrain.obstacles[i].height; height > terrain.air->height)
        add(fmt::format("mesh.terrain.obstacles[{}].height", i),
            fmt::format("{:.6g} m is more than the height of the air, {:.6g} m", height, terrain.air->height));
  }

  void time()
  {
    if (scene_.stages.empty() && scene_.time.end == 0)
      add("time", "time.end or stages must say when the run ends");
    if (!scene_.stages.empty() && scene_.time.end != 0)
      add("time.end", "the stages say when the run ends: leave this out");
    for (std::size_t i = 1; i < scene_.stages.size(); ++i)
      if (const auto* stage = std::get_if<GeostaticSpec>(&scene_.stages[i]);
          stage != nullptr && stage->initial_stress && stage->appear.empty())
        add(fmt::format("stages[{}].initial_stress", i), "only the first stage can set the stress, or one in which bodies appear: theirs");
    for (std::size_t i = 0; i < scene_.stages.size(); ++i)
      if (const auto* stage = std::get_if<GeostaticSpec>(&scene_.stages[i]); stage != nullptr && stage->initial_stress)
        initial_stress(fmt::format("stages[{}].initial_stress", i), static_cast<Index>(i), *stage->initial_stress);
  }

  void initial_stress(const std::string& path, Index number, const K0Spec& spec)
  {
    const auto known = names(scene_.bodies);
    for (std::size_t i = 0; i < spec.bodies.size(); ++i) {
      known_word(fmt::format("{}.bodies[{}].body", path, i), "body", spec.bodies[i].body, known);
      for (std::size_t j = 0; j < i; ++j)
        if (spec.bodies[j].body == spec.bodies[i].body)
          add(fmt::format("{}.bodies[{}].body", path, i), fmt::format("bodies[{}] is about \"{}\" already", j, spec.bodies[i].body));
    }
    for (const std::string& body : known)
      if (presence_of(body, scene_.stages).from == number && spec.of(body).given() == 0)
        add(path, fmt::format("body \"{}\" has no k0: one of k0, k0_table, from_friction or stress is needed for the bodies that the "
                              "list does not name",
                              body));
    if (spec.stress)
      plane_stress(path + ".stress", *spec.stress);
    for (std::size_t i = 0; i < spec.bodies.size(); ++i)
      if (spec.bodies[i].stress)
        plane_stress(fmt::format("{}.bodies[{}].stress", path, i), *spec.bodies[i].stress);
  }

  /// In plane strain nothing is sheared out of the plane.
  void plane_stress(const std::string& path, const UniformStressSpec& stress)
  {
    if (scene_.dimension == 2 && (stress.yz != 0 || stress.xz != 0))
      add(path + (stress.yz != 0 ? ".yz" : ".xz"), "in 2 dimensions there is no shear stress out of the plane: leave this out");
  }

  void materials_and_bodies()
  {
    different_names("materials", scene_.materials);
    different_names("bodies", scene_.bodies);
    const auto known = names(scene_.materials);
    const bool all_known = !known.empty() && std::find(known.begin(), known.end(), "") == known.end();
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      const BodySpec& body = scene_.bodies[i];
      const std::string path = fmt::format("bodies[{}]", i);
      if (all_known)
        known_word(path + ".material", "material", body.material, known);
      fits(path + ".velocity", body.velocity);
      if (body.shape)
        fits(path + ".shape", *body.shape);
      source_of_particles(path, body);
      if (body.saturated_density && !scene_.water)
        add(path + ".saturated_density", "there is no water in this scene: say where its table is, or leave this out");
    }
    if (scene_.initial)
      initial(*scene_.initial);
    if (scene_.water)
      water(*scene_.water);
  }

  /// A body is filled or taken from another run, and what it says is used.  Without a list only that run can tell which are taken.
  void source_of_particles(const std::string& path, const BodySpec& body)
  {
    const auto& list = scene_.initial ? scene_.initial->bodies : std::vector<TakenSpec>{};
    const auto known = names(scene_.bodies);
    const bool listed = std::any_of(list.begin(), list.end(), [&](const TakenSpec& taken) { return taken.body == body.name; });
    const bool misspelt = std::any_of(
        list.begin(), list.end(), [&](const TakenSpec& taken) { return std::find(known.begin(), known.end(), taken.body) == known.end(); });
    if (!body.region.empty() && body.shape)
      return add(path, "only one of region or shape may be given");
    if (misspelt && !listed && !body.fills())
      return;  // it may be the one that is meant
    if (!listed && !body.fills() && (!scene_.initial || !list.empty()))
      return add(path, fmt::format("one of region or shape is needed{}", list.empty() ? "" : ": initial.bodies does not name this body"));
    if (body.fills() && !listed)
      return;
    body.for_each_key_of_filling([&](std::string_view key, bool given) {
      if (given)
        add(fmt::format("{}.{}", path, key), fmt::format("the particles of this body come from initial.from: leave {} out", key));
    });
  }

  void water(const WaterSpec& water)
  {
    const auto known = names(scene_.bodies);
    const auto different_bodies = [&](std::string_view key, const std::vector<std::string>& list) {
      for (auto name = list.begin(); name != list.end(); ++name) {
        const std::string path = fmt::format("water.{}[{}]", key, name - list.begin());
        known_word(path, "body", *name, known);
        if (std::find(list.begin(), name, *name) != name)
          add(path, fmt::format("\"{}\" is named twice", *name));
      }
    };
    different_bodies("bodies", water.bodies);
    different_bodies("undrained", water.undrained);
    if (std::none_of(scene_.loads.begin(), scene_.loads.end(), [](const LoadSpec& l) { return std::holds_alternative<GravitySpec>(l); }))
      add("water", "water has no weight without a load of type gravity");
  }

  void initial(const InitialSpec& initial)
  {
    const auto known = names(scene_.bodies);
    const auto source = [](const TakenSpec& taken) { return taken.from.empty() ? taken.body : taken.from; };
    for (auto taken = initial.bodies.begin(); taken != initial.bodies.end(); ++taken) {
      const std::string path = fmt::format("initial.bodies[{}]", taken - initial.bodies.begin());
      known_word(path + ".body", "body", taken->body, known);
      for (auto earlier = initial.bodies.begin(); earlier != taken; ++earlier) {
        const auto at = earlier - initial.bodies.begin();
        if (!taken->body.empty() && earlier->body == taken->body)
          add(path + ".body", fmt::format("\"{}\" takes its particles by initial.bodies[{}] already", taken->body, at));
        else if (!taken->body.empty() && source(*earlier) == source(*taken))
          add(path, fmt::format("\"{}\" is taken by initial.bodies[{}] already", source(*taken), at));
      }
    }
    if (const auto* stage = scene_.stages.empty() ? nullptr : std::get_if<GeostaticSpec>(&scene_.stages.front());
        stage != nullptr && stage->initial_stress)
      add("stages[0].initial_stress", "the stress comes from initial.from: leave this out");
  }

  void loads_and_boundaries()
  {
    std::optional<std::size_t> gravity;
    for (std::size_t i = 0; i < scene_.loads.size(); ++i) {
      const std::string path = fmt::format("loads[{}]", i);
      if (const auto* load = std::get_if<GravitySpec>(&scene_.loads[i])) {
        fits(path + ".acceleration", load->acceleration);
        if (gravity)
          add(path, fmt::format("gravity is given by loads[{}] already", *gravity));
        gravity = gravity ? gravity : i;
      }
      if (const auto* load = std::get_if<BodyForceSpec>(&scene_.loads[i]))
        fits(path + ".acceleration", load->acceleration);
      if (const auto* load = std::get_if<TractionSpec>(&scene_.loads[i]))
        fits(path + ".traction", load->traction);
    }
    for (std::size_t i = 0; i < scene_.boundaries.size(); ++i) {
      const std::string path = fmt::format("boundaries[{}]", i);
      std::visit(
          [&](const auto& boundary) {
            if constexpr (requires { boundary.velocity; })
              fits(path + ".velocity", boundary.velocity);
          },
          scene_.boundaries[i]);
      if (has_dashpots(scene_.boundaries[i]) && gravity && !begins_at_rest())
        add(path, fmt::format("it carries on what it carried at rest, and nothing says what that is: let the stages begin with a geostatic "
                              "one, take the state from another run (initial), or leave loads[{}] out",
                              *gravity));
    }
  }

  /// In balance with its loads, as far as the scene tells.
  bool begins_at_rest() const
  {
    return scene_.initial || (!scene_.stages.empty() && std::holds_alternative<GeostaticSpec>(scene_.stages.front()));
  }

  void outputs()
  {
    const OutputSpec& outputs = scene_.outputs;
    if (outputs.particles)
      known_fields("outputs.particles.fields", outputs.particles->fields_wanted, particle_field_names());
    if (outputs.mesh)
      known_fields("outputs.mesh.fields", outputs.mesh->fields_wanted, {node_fields.begin(), node_fields.end()});
    known_word("outputs.picture.field", "field", outputs.picture.field, particle_field_names());
    if (outputs.history)
      history(*outputs.history);
    if (outputs.runout)
      runout(*outputs.runout);
  }

  void runout(const RunoutSpec& runout)
  {
    const auto bodies = names(scene_.bodies);
    known_fields("outputs.runout.bodies", runout.bodies, bodies, "body");
    known_fields("outputs.runout.eroded", runout.eroded, bodies, "body");
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
    known_fields("outputs.history.bodies", history.bodies, bodies, "body");
    if (scene_.dimension == 2 || scene_.dimension == 3)
      different_columns(history);
  }

  /// A table with two columns of one name is read differently by different programs.
  void different_columns(const HistoryOutputSpec& history)
  {
    std::map<std::string, std::string> giver;  // of each column
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
    note("every history", "", "", common_columns(scene_.dimension));
    const auto walls = wall_names(scene_.boundaries);
    for (std::size_t i = 0; i < walls.size(); ++i)
      note(fmt::format("boundaries[{}]", i), "on", walls[i], reaction_columns(walls[i], scene_.dimension));
    for (std::size_t i = 0; i < history.points.size(); ++i)
      if (const PointSpec& point = history.points[i]; is_first(history.points, i))
        note(fmt::format("outputs.history.points[{}]", i), "name", point.name, columns_of(point, scene_.dimension));
    for (std::size_t i = 0; i < history.fronts.size(); ++i)
      if (const FrontSpec& front = history.fronts[i]; is_first(history.fronts, i))
        note(fmt::format("outputs.history.fronts[{}]", i), "name", front.name, columns_of(front));
    for (std::size_t i = 0; i < history.walls.size(); ++i)
      if (const WallSpec& wall = history.walls[i];
          std::none_of(history.walls.begin(), history.walls.begin() + static_cast<std::ptrdiff_t>(i),
                       [&](const WallSpec& earlier) { return earlier.on == wall.on; }))
        note(fmt::format("outputs.history.walls[{}]", i), "on", wall.on, columns_of(wall, scene_.dimension));
    for (std::size_t i = 0; i < history.moved.size(); ++i)
      if (const MovedSpec& moved = history.moved[i]; is_first(history.moved, i))
        note(fmt::format("outputs.history.moved[{}]", i), "name", moved.name, columns_of(moved));
    for (std::size_t i = 0; i < history.bodies.size(); ++i)
      if (std::find(history.bodies.begin(), history.bodies.begin() + static_cast<std::ptrdiff_t>(i), history.bodies[i]) ==
          history.bodies.begin() + static_cast<std::ptrdiff_t>(i))
        note("outputs.history", fmt::format("bodies[{}]", i), history.bodies[i], body_columns(history.bodies[i], scene_.dimension));
  }

  /// Of its name; others are found by different_names().
  template <class Item>
  static bool is_first(const std::vector<Item>& items, std::size_t i)
  {
    return std::none_of(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(i),
                        [&](const Item& item) { return item.name == items[i].name; });
  }

  void known_fields(const std::string& path, const std::vector<std::string>& wanted, const std::vector<std::string>& known,
                    std::string_view what = "field")
  {
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      known_word(fmt::format("{}[{}]", path, i), what, wanted[i], known);
      if (!wanted[i].empty() && std::find(wanted.begin(), wanted.begin() + static_cast<std::ptrdiff_t>(i), wanted[i]) !=
                                    wanted.begin() + static_cast<std::ptrdiff_t>(i))
        add(fmt::format("{}[{}]", path, i), fmt::format("\"{}\" is asked for twice", wanted[i]));
    }
  }

  /// Those of every particle, and the history variables of the laws in this scene.
  std::vector<std::string> particle_field_names() const
  {
    std::vector<std::string> known(particle_fields.begin(), particle_fields.end());
    const auto add_history = [&]<class Law>(const Law&) {
      for_each_field<typename Law::State>([&](const auto& variable) { known.emplace_back(variable.key); });
    };
    for (const MaterialSpec& material : scene_.materials)
      std::visit(add_history, material.law);
    return known;
  }

  const Scene& scene_;
  std::vector<Finding> findings_;
};

}  // namespace

std::vector<Finding> broken_rules(const Scene& scene) { return Rules(scene).broken(); }

std::vector<std::string> kernel_names()
{
  std::vector<std::string> names;
  for_each_type(Kernels<2>{}, [&]<class K>() {
    constexpr std::string_view name = K::name;  // by value: nothing of the kernel is linked
    names.emplace_back(name);
  });
  return names;
}

}  // namespace talus
