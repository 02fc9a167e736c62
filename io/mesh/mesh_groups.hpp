#pragma once
// Names for parts of a mesh that no mesher gave: sides of the bounding box, the hull, outlines of cell groups, facets in boxes.
#include <span>

#include "io/scene/scene.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// Adds facet sets: `x_min` ... `z_max`, the boundary facets on the sides of the bounding box (none where the boundary only touches
/// it); `boundary`, all of them; `<group>:boundary` for every cell group, the facets between it and the rest or the outside.
/// A group that exists already is left as it is.
template <int D>
void add_automatic_groups(MeshData<D>& data);

/// Adds the sides of regions that have names: `<region>:<side>` for each named side of a polygon, `<region>:hole_<i>` for its holes, counted from
/// 1, and `<region>:inner` for the inside of a ring, chosen from the outline of the region.  Throws SceneErrors for a named side on which no facet
/// of the region lies, and for names the mesh has already.  Call it after add_automatic_groups().
template <int D>
void add_side_groups(MeshData<D>& data, std::span<const RegionSpec> regions);

/// Adds the facet sets of the scene, in order, chosen from sets that exist: call it after add_automatic_groups().  Throws SceneErrors
/// for a box that is none, where no facet lies in the box or faces the direction, for a name the mesh has already, and for a set to choose from that it has not.
template <int D>
void add_groups(MeshData<D>& data, std::span<const GroupSpec> groups);

extern template void add_automatic_groups<2>(MeshData<2>&);
extern template void add_automatic_groups<3>(MeshData<3>&);
extern template void add_side_groups<2>(MeshData<2>&, std::span<const RegionSpec>);
extern template void add_side_groups<3>(MeshData<3>&, std::span<const RegionSpec>);
extern template void add_groups<2>(MeshData<2>&, std::span<const GroupSpec>);
extern template void add_groups<3>(MeshData<3>&, std::span<const GroupSpec>);

}  // namespace talus
