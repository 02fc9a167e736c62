#pragma once
// Rasters as surfaces.
#include <vector>

#include "mesh/geometry/raster.hpp"
#include "mesh/geometry/surface.hpp"

namespace talus {

MapBox extent_of(const Raster& raster);

/// Bilinear between the centres of cells, going on straight over the outer half of the outermost ones; NaN outside and beside cells that
/// have no value.
Surface surface_of(Raster raster);

/// Cells without a value that touch each other, by a side or a corner.
struct RasterHole {
  Index cells = 0, across = 0;  ///< across: columns or rows, whichever are more
  MapBox extent;
  bool filled = false;
};

/// Gives values to the cells of holes that are at most `largest` cells across and do not touch the edge of the raster: those of a stretched
/// membrane (Laplace's equation), which has neither peaks nor pits of its own.  Returns all holes but those that touch the edge.
std::vector<RasterHole> fill_holes(Index largest, Raster& raster);

}  // namespace talus
