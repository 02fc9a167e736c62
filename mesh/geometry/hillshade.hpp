#pragma once
// Shading of a surface for maps.
#include "mesh/geometry/plan_grid.hpp"
#include "mesh/geometry/raster.hpp"

namespace talus {

/// The cells of the raster as a grid on the map.
PlanGrid grid_of(const Raster& raster);

/// The brightness of each cell, 0 to 1, in light from the north-west (azimuth 315 degrees) at 45 degrees above the horizon, with Horn's
/// slopes (1981).  NaN where the raster has no value.
std::vector<Real> hillshade(const Raster& elevation);

}  // namespace talus
