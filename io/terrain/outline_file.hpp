#pragma once
// Outlines that a scene names, read from files.
#include "io/terrain/polygon_file.hpp"
#include "io/terrain/surface_file.hpp"

namespace talus {

/// The polygons of a file in map coordinates, reprojected if the file has another coordinate system.  Empty after an error.
std::vector<MapPolygon> read_outlines(const std::string& file, const SourceLocation& where, const MapPlan& plan,
                                      std::vector<SceneError>& problems, std::vector<std::string>& repairs);

}  // namespace talus
