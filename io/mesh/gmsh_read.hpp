#pragma once
// Reads the mesh files of gmsh without gmsh, whose own reader crashes or hangs on damaged binary files.
#include <filesystem>

#include "core/error.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// A .msh file of format 2.2 or 4.1, ascii or binary.  Physical groups become named sets: of dimension D cell sets, of D-1 facet
/// sets, of lower dimension node sets.  In 2-D the nodes must share one z, which is dropped.  Nodes are in the order of the file.
/// Throws SceneErrors at the line (ascii) or byte (binary) that is wrong, naming the place `asked_by` that wanted the mesh.
template <int D>
MeshData<D> read_msh(const std::filesystem::path& file, const SourceLocation& asked_by);

extern template MeshData<2> read_msh<2>(const std::filesystem::path&, const SourceLocation&);
extern template MeshData<3> read_msh<3>(const std::filesystem::path&, const SourceLocation&);

}  // namespace talus
