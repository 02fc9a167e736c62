#pragma once
// Cells over the plan: what moves in space is counted on them.
#include <array>
#include <cstddef>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// columns x rows cells of dx by dy [m] from a corner on, in the order of a Raster.  In 2-D there is one row, of dy = 1 m.
struct PlanGrid {
  Index columns = 0, rows = 0;
  Real west = 0, south = 0;  ///< lower left corner [m]
  Real dx = 1, dy = 1;
  std::size_t size() const noexcept { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  Real area() const noexcept { return dx * dy; }
  std::size_t cell(Index column, Index row) const noexcept
  {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  }
  std::array<Real, 2> centre(Index column, Index row) const noexcept { return {west + (column + 0.5) * dx, south + (row + 0.5) * dy}; }
};

/// A share of something in a cell.
struct CellShare {
  std::size_t cell;
  Real share;
};

/// A square of that side [m] about a place, shared out by area; what lies beyond the rim goes to the cells at the rim, so the shares add up
/// to 1.
void spread(const PlanGrid& grid, const std::array<Real, 2>& place, Real side, std::vector<CellShare>& shares);

/// The value at a place: linear between the centres around it, of those that have one; NaN where the nearest has none.
Real sampled(const PlanGrid& grid, const std::vector<Real>& values, const std::array<Real, 2>& place);

}  // namespace talus
