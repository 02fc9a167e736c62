#pragma once
// A mesh of terrain: ground, layers below it, air above it, obstacles left out.
#include <filesystem>
#include <string>

#include "io/scene/scene.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// Cell groups layer:NAME and air.  Facet groups: base, the lowest facets; terrain, the surface of the ground, be it between layers and air or at the
/// top or bottom of the mesh; top, that of the air; sides, the upright rim; layer:NAME:bottom; obstacle:NAME.
/// SceneErrors with everything that is wrong; what was mended stands in the notes.
template <int D>
MeshData<D> make_terrain(const MeshSpec& spec, const std::filesystem::path& directory);

/// Where such a mesh lies on the map and how much its cell groups hold; lines that begin with `margin`, none for other meshes.
template <int D>
std::string terrain_in_words(const Mesh<D>& mesh, std::string_view margin);

extern template MeshData<2> make_terrain<2>(const MeshSpec&, const std::filesystem::path&);
extern template MeshData<3> make_terrain<3>(const MeshSpec&, const std::filesystem::path&);
extern template std::string terrain_in_words<2>(const Mesh<2>&, std::string_view);
extern template std::string terrain_in_words<3>(const Mesh<3>&, std::string_view);

}  // namespace talus
