#include "mesh/geometry/raster_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace talus {

namespace {

constexpr Real no_value = std::numeric_limits<Real>::quiet_NaN();

/// The first of two neighbouring centres, and the distance of a position from it in spacings.
struct Between {
  Index first, second;
  Real share;
};
Between between(Real centres, Index count)
{
  const auto first = static_cast<Index>(std::clamp(std::floor(centres), Real{0}, static_cast<Real>(std::max(Index{0}, count - 2))));
  return {first, std::min(first + 1, count - 1), count > 1 ? centres - static_cast<Real>(first) : 0};
}

struct Cell {
  Index column, row;
};

bool is_hole(const Raster& raster, Cell cell) { return std::isnan(raster.at(cell.column, cell.row)); }
bool at_edge(const Raster& raster, Cell cell)
{
  return cell.column == 0 || cell.row == 0 || cell.column == raster.columns - 1 || cell.row == raster.rows - 1;
}

/// All cells without a value that are connected to the first.
std::vector<Cell> cells_of_hole(const Raster& raster, Cell first, std::vector<bool>& seen)
{
  std::vector<Cell> cells{first};
  const auto mark = [&](Cell cell) {
    auto there =
        seen[static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(raster.columns) + static_cast<std::size_t>(cell.column)];
    const bool is_new = !there;
    there = true;
    return is_new;
  };
  mark(first);
  for (std::size_t next = 0; next < cells.size(); ++next) {
    const Cell here = cells[next];
    for (Index row = std::max(Index{0}, here.row - 1); row <= std::min(raster.rows - 1, here.row + 1); ++row)
      for (Index column = std::max(Index{0}, here.column - 1); column <= std::min(raster.columns - 1, here.column + 1); ++column)
        if (const Cell cell{column, row}; is_hole(raster, cell) && mark(cell))
          cells.push_back(cell);
  }
  return cells;
}

/// Solves Laplace's equation by sweeps: every cell becomes the mean of its four neighbours until the changes are negligible.
void stretch_over(const std::vector<Cell>& cells, Raster& raster)
{
  const auto neighbours = [&](Cell cell) {
    return std::array{raster.at(cell.column - 1, cell.row), raster.at(cell.column + 1, cell.row), raster.at(cell.column, cell.row - 1),
                      raster.at(cell.column, cell.row + 1)};
  };
  Real sum = 0, low = std::numeric_limits<Real>::infinity(), high = -low;
  int count = 0;
  for (const Cell cell : cells)
    for (const Real value : neighbours(cell))
      if (!std::isnan(value)) {
        sum += value;
        low = std::min(low, value);
        high = std::max(high, value);
        ++count;
      }
  for (const Cell cell : cells)
    raster.at(cell.column, cell.row) = sum / count;
  constexpr Real enough = 1e-9;  // tolerance relative to the range of the surrounding values
  constexpr int most_sweeps = 10000;
  Real change = high - low;
  for (int sweep = 0; sweep < most_sweeps && change > enough * (high - low); ++sweep) {
    change = 0;
    for (const Cell cell : cells) {
      const auto [w, e, s, n] = neighbours(cell);
      Real& value = raster.at(cell.column, cell.row);
      change = std::max(change, std::abs(0.25 * (w + e + s + n) - value));
      value = 0.25 * (w + e + s + n);
    }
  }
}

}  // namespace

MapBox extent_of(const Raster& raster)
{
  return {raster.west, raster.south, raster.west + raster.dx * static_cast<Real>(raster.columns),
          raster.south + raster.dy * static_cast<Real>(raster.rows)};
}

Surface surface_of(Raster raster)
{
  return [shared = std::make_shared<const Raster>(std::move(raster))](const std::array<Real, 2>& place) {
    const Raster& r = *shared;
    const Real x = (place[0] - r.west) / r.dx, y = (place[1] - r.south) / r.dy;
    // Positions outside by round-off count as inside.
    constexpr Real slack = 1e-6;
    if (!(x >= -slack && x <= static_cast<Real>(r.columns) + slack && y >= -slack && y <= static_cast<Real>(r.rows) + slack))
      return no_value;
    const Between u = between(x - 0.5, r.columns), v = between(y - 0.5, r.rows);
    // A neighbour with zero weight may have no value.
    const auto mixed = [](Real a, Real b, Real share) { return share == 0 ? a : share == 1 ? b : a + share * (b - a); };
    return mixed(mixed(r.at(u.first, v.first), r.at(u.second, v.first), u.share),
                 mixed(r.at(u.first, v.second), r.at(u.second, v.second), u.share), v.share);
  };
}

std::vector<RasterHole> fill_holes(Index largest, Raster& raster)
{
  std::vector<RasterHole> holes;
  std::vector<bool> seen(raster.values.size());
  for (Index row = 0; row < raster.rows; ++row)
    for (Index column = 0; column < raster.columns; ++column) {
      const std::size_t here = static_cast<std::size_t>(row) * static_cast<std::size_t>(raster.columns) + static_cast<std::size_t>(column);
      if (seen[here] || !is_hole(raster, {column, row}))
        continue;
      const std::vector<Cell> cells = cells_of_hole(raster, {column, row}, seen);
      if (std::any_of(cells.begin(), cells.end(), [&](Cell cell) { return at_edge(raster, cell); }))
        continue;
      const auto [west, east] = std::minmax_element(cells.begin(), cells.end(), [](Cell a, Cell b) { return a.column < b.column; });
      const auto [south, north] = std::minmax_element(cells.begin(), cells.end(), [](Cell a, Cell b) { return a.row < b.row; });
      RasterHole hole;
      hole.cells = static_cast<Index>(cells.size());
      hole.across = 1 + std::max(east->column - west->column, north->row - south->row);
      hole.extent = {raster.west + raster.dx * static_cast<Real>(west->column), raster.south + raster.dy * static_cast<Real>(south->row),
                     raster.west + raster.dx * static_cast<Real>(east->column + 1),
                     raster.south + raster.dy * static_cast<Real>(north->row + 1)};
      hole.filled = hole.across <= largest;
      if (hole.filled)
        stretch_over(cells, raster);
      holes.push_back(hole);
    }
  return holes;
}

}  // namespace talus
