#pragma once
// A mesh of terrain: ground, layers below it, air above it, without the obstacles.
#include <filesystem>
#include <string>

#include "io/scene/scene.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// The mesh.  Cell groups: layer:NAME and air.  Facet groups: base, the lowest facets; terrain, the surface of the ground, between layers
/// and air or at the top or bottom of the mesh; top, that of the air; sides, the upright boundary; layer:NAME:bottom; obstacle:NAME.
/// Throws SceneErrors with all errors; corrections are described in the notes.
template <int D>
MeshData<D> make_terrain(const MeshSpec& spec, const std::filesystem::path& directory);

/// The position of such a mesh on the map and the volumes of its cell groups as lines that begin with `margin`; empty for other meshes.
template <int D>
std::string terrain_in_words(const Mesh<D>& mesh, std::string_view margin);

}  // namespace talus
