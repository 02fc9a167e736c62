#pragma once
// How a surface over the plan looks in the light.
#include "mesh/geometry/plan_grid.hpp"
#include "mesh/geometry/raster.hpp"

namespace talus {

/// Its cells, on the map.
PlanGrid grid_of(const Raster& raster);

/// Light on a slope for each cell, 0 to 1, from the north-west (azimuth 315 degrees) at 45 degrees above the level: the shading of maps, by
/// Horn's slopes (1981).  NaN where the raster has no value.
std::vector<Real> hillshade(const Raster& elevation);

}  // namespace talus
