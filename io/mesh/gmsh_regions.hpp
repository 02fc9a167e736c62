#pragma once
// What gmsh is asked to mesh: a geometry file, or the inline solids of a scene.
#include <filesystem>
#include <functional>
#include <vector>

#include "io/scene/scene.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// A .geo (run), .step, .stp, .brep or .iges (imported in metres); sizes and groups as make_mesh() says.
template <int D>
MeshData<D> mesh_geometry(const MeshSpec& spec, const std::filesystem::path& file);

/// The regions as cell groups.  Where two overlap the later one gives way; regions that touch share their faces.
template <int D>
MeshData<D> mesh_regions(const MeshSpec& spec);

/// Triangles of edge length size(place), no more than `largest`, in the polygons, with edges along the sides of all of them.
MeshData<2> mesh_plan(const std::vector<Polygon>& polygons, const std::function<Real(const Vec<2>&)>& size, Real largest,
                      const SourceLocation& where);

extern template MeshData<2> mesh_geometry<2>(const MeshSpec&, const std::filesystem::path&);
extern template MeshData<3> mesh_geometry<3>(const MeshSpec&, const std::filesystem::path&);
extern template MeshData<2> mesh_regions<2>(const MeshSpec&);
extern template MeshData<3> mesh_regions<3>(const MeshSpec&);

}  // namespace talus
