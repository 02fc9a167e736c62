#include "mesh/geometry/hillshade.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talus {

PlanGrid grid_of(const Raster& raster) { return {raster.columns, raster.rows, raster.west, raster.south, raster.dx, raster.dy}; }

std::vector<Real> hillshade(const Raster& elevation)
{
  const PlanGrid grid = grid_of(elevation);
  const Real light = std::sqrt(0.5);  // components of the direction to the light: upwards, and horizontally to the north-west
  std::vector<Real> shade(grid.size(), std::numeric_limits<Real>::quiet_NaN());
  for (Index row = 0; row < grid.rows; ++row)
    for (Index column = 0; column < grid.columns; ++column) {
      const Real here = elevation.at(column, row);
      if (std::isnan(here))
        continue;
      // Outside the raster and in holes the elevation of this cell is used.
      const auto z = [&](Index right, Index up) {
        const Real value =
            elevation.at(std::clamp(column + right, Index{0}, grid.columns - 1), std::clamp(row + up, Index{0}, grid.rows - 1));
        return std::isnan(value) ? here : value;
      };
      const Real east = (z(1, 1) + 2 * z(1, 0) + z(1, -1) - z(-1, 1) - 2 * z(-1, 0) - z(-1, -1)) / (8 * grid.dx);
      const Real north = (z(1, 1) + 2 * z(0, 1) + z(-1, 1) - z(1, -1) - 2 * z(0, -1) - z(-1, -1)) / (8 * grid.dy);
      const Real towards = std::sqrt(0.5) * (east - north);  // slope towards the north-west
      shade[grid.cell(column, row)] = std::max(Real{0}, light * (1 + towards) / std::sqrt(1 + east * east + north * north));
    }
  return shade;
}

}  // namespace talus
