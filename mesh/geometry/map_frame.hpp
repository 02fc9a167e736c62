#pragma once
// The position of a scene on a map.
#include <array>
#include <string>

#include "core/types.hpp"

namespace talus {

/// The transformation from scene to map.  Scenes have coordinates near their origin, maps have large ones.
struct MapFrame {
  std::array<Real, 2> origin{};     ///< position on the map [m] of x = y = 0 (3-D), of x = 0 (2-D)
  std::array<Real, 2> along{1, 0};  ///< 2-D: direction of x on the map, of unit length
  std::string crs;                  ///< coordinate system as GDAL understands it, such as "EPSG:32633" or WKT; empty if unknown
  /// The position on the map [m] of (x, y) in 3-D; of x, with y = 0, in 2-D.
  std::array<Real, 2> to_map(Real x, Real y = 0) const noexcept
  {
    return {origin[0] + x * along[0] - y * along[1], origin[1] + x * along[1] + y * along[0]};
  }
};

}  // namespace talus
