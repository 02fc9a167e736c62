#pragma once
// The mesh of a scene from any source: a .msh file, gmsh, or the built-in box.
#include <filesystem>

#include "io/scene/scene.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// Reads, meshes or generates the mesh, then names the groups of the scene and the automatic ones (mesh_groups.hpp).  Relative paths start
/// in `directory`, the folder of the scene.  Equal specs give bitwise identical meshes: gmsh runs on one thread with a fixed seed.
///
/// `geometry`: a .geo is executed, a .step imported in metres.  As in gmsh, physical groups of dimension D select the cells, if there are
/// any.  The solids of a .step become cell groups by their names (without one: part_1, part_2, ...) and share faces.  `size` is an upper
/// bound of the sizes at the points of a .geo.  `regions` are meshed with edges of length `size`.  Throws SceneErrors at the position of
/// the spec, with the messages of gmsh.
template <int D>
MeshData<D> make_mesh(const MeshSpec& spec, const std::filesystem::path& directory);

/// The mesh, checked and renumbered; errors of Mesh become SceneErrors too.
template <int D>
Mesh<D> load_mesh(const MeshSpec& spec, const std::filesystem::path& directory);

/// The mesh of a scene, with nodes doubled along its cuts.  Throws SceneErrors at the position of a cut whose group does not exist or is
/// no cut.
template <int D>
Mesh<D> load_mesh(const Scene& scene, const std::filesystem::path& directory);

}  // namespace talus
