#pragma once
// Triangles in space as surfaces over the plan.
#include <array>
#include <vector>

#include "mesh/geometry/surface.hpp"

namespace talus {

struct TriangleSheet {
  std::vector<std::array<Real, 3>> corners;     ///< (x, y, z), on the map
  std::vector<std::array<Index, 3>> triangles;  ///< in any order and turned either way
};

/// The highest of the triangles over or under a place; NaN where there is none.  Upright triangles count for nothing.
Surface surface_of(TriangleSheet sheet);

}  // namespace talus
