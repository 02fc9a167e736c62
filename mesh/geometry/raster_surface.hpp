#pragma once
// Surfaces made from rasters.
#include <vector>

#include "mesh/geometry/raster.hpp"
#include "mesh/geometry/surface.hpp"

namespace talus {

MapBox extent_of(const Raster& raster);

/// Bilinear interpolation between the centres of cells, with linear extrapolation over the outer half of the outermost cells; NaN outside
/// and beside cells without a value.
Surface surface_of(Raster raster);

/// A connected group of cells without a value; cells are connected by a side or a corner.
struct RasterHole {
  Index cells = 0, across = 0;  ///< number of cells; columns or rows that it covers, whichever are more
  MapBox extent;
  bool filled = false;
};

/// Fills holes of at most `largest` cells across that do not touch the edge of the raster, by Laplace's equation: the filled surface has no
/// peaks or pits of its own.  Returns all other holes that do not touch the edge.
std::vector<RasterHole> fill_holes(Index largest, Raster& raster);

}  // namespace talus
