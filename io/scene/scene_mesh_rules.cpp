// Rules of the block `mesh`.
#include <array>

#include "io/scene/scene_rule_base.hpp"

namespace talus {

namespace {

class MeshRules : private SceneRuleBase {
 public:
  using SceneRuleBase::SceneRuleBase;

  std::vector<Finding> broken()
  {
    mesh();
    return std::move(findings_);
  }

 private:
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
};

}  // namespace

std::vector<Finding> broken_mesh_rules(const Scene& scene) { return MeshRules(scene).broken(); }

}  // namespace talus
