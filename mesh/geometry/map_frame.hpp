#pragma once
// Where the coordinates of a scene lie on a map.
#include <array>
#include <string>

#include "core/types.hpp"

namespace talus {

/// Scenes compute near their origin, maps count from far away: what is shown on a map is shifted back.
struct MapFrame {
  std::array<Real, 2> origin{};     ///< place on the map [m] of x = y = 0 (3-D), of x = 0 (2-D)
  std::array<Real, 2> along{1, 0};  ///< 2-D: direction of x on the map, of unit length
  std::string crs;                  ///< coordinate system as GDAL understands it, "EPSG:32633" or WKT; empty: not known
  /// Place on the map [m] of (x, y) in 3-D; of x, with y = 0, in 2-D.
  std::array<Real, 2> to_map(Real x, Real y = 0) const noexcept
  {
    return {origin[0] + x * along[0] - y * along[1], origin[1] + x * along[1] + y * along[0]};
  }
};

}  // namespace talus
