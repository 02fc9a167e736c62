#pragma once
// Surfaces of triangles in STL files, as written by CAD programs.
#include <filesystem>

#include "mesh/geometry/triangle_surface.hpp"

namespace talus {

/// Reads the binary or ASCII format; every triangle has its own corners.  Throws SceneErrors with line or byte of an error,
/// EnvironmentError if the file cannot be read.
TriangleSheet read_stl(const std::filesystem::path& file);

}  // namespace talus
