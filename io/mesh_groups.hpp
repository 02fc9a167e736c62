#pragma once
// Names for parts of a mesh that no mesher gave: sides of the bounding box, the hull, outlines of cell groups, facets in boxes.
#include <span>

#include "io/scene.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// Adds facet sets: `x_min` ... `z_max`, the boundary facets on the sides of the bounding box (none where the boundary only touches
/// it); `boundary`, all of them; `<group>:boundary` for every cell group, the facets between it and the rest or the outside.
/// A group that exists already is left as it is.
template <int D>
void add_automatic_groups(MeshData<D>& data);

/// Adds the facet sets of the scene, in order, chosen from sets that exist: call it after add_automatic_groups().  Throws SceneErrors
/// for a box that is none or holds no facet, for a name the mesh has already, and for a set to choose from that it has not.
template <int D>
void add_groups(MeshData<D>& data, std::span<const GroupSpec> groups);

extern template void add_automatic_groups<2>(MeshData<2>&);
extern template void add_automatic_groups<3>(MeshData<3>&);
extern template void add_groups<2>(MeshData<2>&, std::span<const GroupSpec>);
extern template void add_groups<3>(MeshData<3>&, std::span<const GroupSpec>);

}  // namespace talus
