#pragma once
// The way to gmsh, which is a part of its own (libtalus_gmsh.so): it brings a hundred libraries, and to load them takes longer than many a
// command. It is opened where a mesh is to be made by gmsh.
#include "io/mesh/gmsh_regions.hpp"

namespace talus {

/// The functions of gmsh_regions.hpp, as the part hands them out.
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

/// EnvironmentError: the part is not where it belongs, beside the program or its libraries, or cannot be loaded.
const GmshPart& gmsh();
/// Its functions for one dimension.
template <int D>
const GmshFunctions<D>& gmsh();

extern template const GmshFunctions<2>& gmsh<2>();
extern template const GmshFunctions<3>& gmsh<3>();

}  // namespace talus
