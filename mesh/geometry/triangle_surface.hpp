#pragma once
// Surfaces over the plan made from triangles in space.
#include <array>
#include <vector>

#include "mesh/geometry/surface.hpp"

namespace talus {

struct TriangleSheet {
  std::vector<std::array<Real, 3>> corners;     ///< positions (x, y, z) on the map [m]
  std::vector<std::array<Index, 3>> triangles;  ///< in any order and orientation
};

/// The elevation of the highest triangle at a position; NaN where there is none.  Upright triangles are ignored.
Surface surface_of(TriangleSheet sheet);

}  // namespace talus
