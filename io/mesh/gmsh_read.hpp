#pragma once
// Reads the mesh files of gmsh without gmsh, whose own reader crashes or hangs on damaged binary files.
#include <filesystem>

#include "core/error.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// Reads a .msh file of format 2.2 or 4.1, ASCII or binary.  Physical groups become named sets: of dimension D cell sets, of D-1 facet
/// sets, of lower dimension node sets.  In 2-D all nodes must have the same z, which is dropped.  Nodes are in the order of the file.
/// Throws SceneErrors with line (ASCII) or byte (binary) of the error and the position `asked_by` in the scene.
template <int D>
MeshData<D> read_msh(const std::filesystem::path& file, const SourceLocation& asked_by);

}  // namespace talus
