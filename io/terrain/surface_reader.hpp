#pragma once
// A surface from a file: a raster, points or triangles.
#include "io/terrain/surface_file.hpp"

namespace talus {

/// As read_surface(); `file` is relative to the directory of the plan.
std::optional<SurfaceRead> read_surface_file(const std::string& file, const SourceLocation& where, MapPlan& plan,
                                             std::vector<SceneError>& problems, std::vector<std::string>& repairs);

}  // namespace talus
