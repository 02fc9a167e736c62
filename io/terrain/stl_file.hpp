#pragma once
// Surfaces of triangles in STL files, as CAD programs write them.
#include <filesystem>

#include "mesh/geometry/triangle_surface.hpp"

namespace talus {

/// Binary or ascii; every triangle has corners of its own.  SceneErrors name the place in the file: its line, or the byte; what cannot be
/// read at all is an EnvironmentError.
TriangleSheet read_stl(const std::filesystem::path& file);

}  // namespace talus
