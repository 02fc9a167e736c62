#pragma once
// Automatic groups of a mesh: sides of the bounding box, the boundary, outlines of cell groups, facets in boxes.
#include <span>

#include "io/scene/scene.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// Adds facet sets: `x_min` ... `z_max`, the boundary facets on the sides of the bounding box (none where the boundary only touches it);
/// `boundary`, all boundary facets; `<group>:boundary` for every cell group, the facets between it and other cells or the outside.  An
/// existing group is not changed.
template <int D>
void add_automatic_groups(MeshData<D>& data);

/// Adds the named sides of regions: `<region>:<side>` for each named side of a polygon, `<region>:hole_<i>` for its holes, counted from 1,
/// and `<region>:inner` for the inside of a ring, selected from the outline of the region.  Throws SceneErrors for a named side without
/// facets of the region, and for existing names.  To be called after add_automatic_groups().
template <int D>
void add_side_groups(MeshData<D>& data, std::span<const RegionSpec> regions);

/// Adds the facet sets of the scene, in order, selected from existing sets.  To be called after add_automatic_groups().  Throws SceneErrors
/// for an invalid box, if no facet lies in the box or faces the direction, for existing names, and for a missing set to select from.
template <int D>
void add_groups(MeshData<D>& data, std::span<const GroupSpec> groups);

}  // namespace talus
