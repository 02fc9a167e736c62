#pragma once
// The contents of a block `mesh.terrain`: surfaces, areas, and the position on the map.
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
  bool is_line = false;                     ///< whether the plan is a line (2-D)
  bool on_map = true;                       ///< false in 2-D without a section, where x is not a map coordinate
  Surface ground;                           ///< this and the other surfaces: elevation [m] at a position of the map
  std::vector<Surface> bottoms;             ///< of each layer
  std::vector<std::optional<Area>> within;  ///< areas of the layers; without one a layer is everywhere
  std::vector<Area> obstacles;
  Area domain;                     ///< in 2-D only its width along the line is used
  bool is_rectangle = false;       ///< whether the domain is a rectangle with sides along the axes
  Real from = 0, to = 0;           ///< 2-D: range of x
  std::vector<Real> kinks;         ///< 2-D: positions x of the corners of lines given by points
  std::vector<std::string> notes;  ///< descriptions of corrections
};

/// Throws SceneErrors with everything that cannot be read or is impossible.
template <int D>
TerrainInput read_terrain(const TerrainSpec& spec, const std::filesystem::path& directory);

}  // namespace talus
