#pragma once
// Meshing by gmsh: of a geometry file, or of the inline solids of a scene.
#include <filesystem>
#include <functional>
#include <vector>

#include "io/scene/scene.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// Meshes a .geo (executed), .step, .stp, .brep or .iges (imported in metres); sizes and groups as in make_mesh().
template <int D>
MeshData<D> mesh_geometry(const MeshSpec& spec, const std::filesystem::path& file);

/// Meshes the regions as cell groups.  An overlap belongs to the earlier region; regions that touch share their faces.
template <int D>
MeshData<D> mesh_regions(const MeshSpec& spec);

/// Triangles with edges of length size(place), at most `largest`, in the polygons, with edges along the sides of all of them.
MeshData<2> mesh_plan(const std::vector<Polygon>& polygons, const std::function<Real(const Vec<2>&)>& size, Real largest,
                      const SourceLocation& where);

}  // namespace talus
