#pragma once
// Access to gmsh, which is in a plugin (libtalus_gmsh.so), because it loads a hundred libraries and that takes longer than many a command.
// The plugin is opened when gmsh has to make a mesh.
#include "io/mesh/gmsh_regions.hpp"

namespace talus {

/// The functions of gmsh_regions.hpp, as exported by the plugin.
template <int D>
struct GmshFunctions {
  MeshData<D> (*mesh_geometry)(const MeshSpec&, const std::filesystem::path&);
  MeshData<D> (*mesh_regions)(const MeshSpec&);
};
struct GmshPart {
  GmshFunctions<2> in_2d;
  GmshFunctions<3> in_3d;
  MeshData<2> (*mesh_plan)(const std::vector<Polygon>&, const std::function<Real(const Vec<2>&)>&, Real, const SourceLocation&);
};

/// The plugin.  Throws EnvironmentError if it is not beside the program or its libraries, or cannot be loaded.
const GmshPart& gmsh();
/// The functions for one dimension.
template <int D>
const GmshFunctions<D>& gmsh();

}  // namespace talus
