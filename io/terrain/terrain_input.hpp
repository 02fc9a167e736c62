#pragma once
// What a block `mesh.terrain` speaks of, read: surfaces, areas, and where all of it lies on the map.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/scene/scene_terrain.hpp"
#include "mesh/geometry/area.hpp"
#include "mesh/geometry/map_frame.hpp"
#include "mesh/geometry/surface.hpp"

namespace talus {

struct TerrainInput {
  MapFrame frame;
  bool is_line = false;                     ///< 2-D: the plan is a line
  bool on_map = true;                       ///< false in 2-D without a section: x is x
  Surface ground;                           ///< all surfaces: elevation [m] at a place of the map
  std::vector<Surface> bottoms;             ///< of the layers
  std::vector<std::optional<Area>> within;  ///< of the layers; without one everywhere
  std::vector<Area> obstacles;
  Area domain;                     ///< 2-D: its width along the line counts
  bool is_rectangle = false;       ///< the domain, its sides along the axes
  Real from = 0, to = 0;           ///< 2-D: ends of x
  std::vector<Real> kinks;         ///< 2-D: places x where lines that were given by points have corners
  std::vector<std::string> notes;  ///< what was mended, in words
};

/// SceneErrors with everything that cannot be read or cannot be.
template <int D>
TerrainInput read_terrain(const TerrainSpec& spec, const std::filesystem::path& directory);

extern template TerrainInput read_terrain<2>(const TerrainSpec&, const std::filesystem::path&);
extern template TerrainInput read_terrain<3>(const TerrainSpec&, const std::filesystem::path&);

}  // namespace talus
