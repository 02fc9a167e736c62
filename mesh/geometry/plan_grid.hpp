#pragma once
// A grid of cells over the plan, in which moving quantities are counted.
#include <array>
#include <cstddef>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// columns x rows cells of dx by dy [m], in the order of a Raster.  In 2-D there is one row with dy = 1 m.
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

/// A cell and the fraction of a quantity in it.
struct CellShare {
  std::size_t cell;
  Real share;
};

/// Distributes a square with the given side [m] around a position by area.  Parts outside the grid go to the cells at its boundary, so the
/// fractions sum to 1.
void spread(const PlanGrid& grid, const std::array<Real, 2>& place, Real side, std::vector<CellShare>& shares);

/// The value at a position: linear between the surrounding centres that have a value; NaN where the nearest one has none.
Real sampled(const PlanGrid& grid, const std::vector<Real>& values, const std::array<Real, 2>& place);

}  // namespace talus
