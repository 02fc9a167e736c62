#pragma once
// Values on a grid over the plan: terrain as input, maps as output.
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// Cells of dx by dy [m] with a value at each centre; NaN where there is no value.
struct Raster {
  Index columns = 0, rows = 0;
  Real west = 0, south = 0;  ///< lower left corner of the lower left cell, on the map [m]
  Real dx = 1, dy = 1;       ///< size of a cell [m]
  std::vector<Real> values;  ///< row by row from the south, each row from the west
  std::string crs;           ///< coordinate system, see MapFrame
  std::string unit;          ///< unit of the values, such as "m"; empty if they have none
  Real& at(Index column, Index row)
  {
    return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
  }
  Real at(Index column, Index row) const
  {
    return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
  }
};

}  // namespace talus
