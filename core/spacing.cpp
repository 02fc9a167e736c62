#include "core/spacing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/parallel.hpp"

namespace talus {

namespace {

constexpr std::size_t sample = 250;  // points asked for their neighbours: each looks at all others, which takes no tree for so few

constexpr Real widest_hole = 1.8;         // radius of a void over that of the disks
constexpr Real fineness = 6;              // places of the grid over a radius
constexpr std::size_t most_places = 4e7;  // of the grid: coarser where it would have more

/// How far each place of a grid is from the nearest point.
struct NearestPoints {
  Real low_x, low_y, step;
  std::size_t columns, rows;
  std::vector<float> distance;  ///< infinite where none is near [m]
  std::vector<Index> nearest;
};

NearestPoints nearest_points(std::span<const Real> positions, Real radius)
{
  constexpr Real infinity = std::numeric_limits<Real>::infinity();
  std::array<Real, 2> low{infinity, infinity}, high{-infinity, -infinity};
  for (std::size_t p = 0; p < positions.size(); p += 3)
    for (std::size_t d = 0; d < 2; ++d)
      low[d] = std::min(low[d], positions[p + d]), high[d] = std::max(high[d], positions[p + d]);
  const Real reach = widest_hole * radius, margin = 2 * reach;
  const Real width = high[0] - low[0] + 2 * margin, height = high[1] - low[1] + 2 * margin;
  const Real step = std::max(radius / fineness, std::sqrt(width * height / static_cast<Real>(most_places)));
  NearestPoints grid{low[0] - margin,
                     low[1] - margin,
                     step,
                     static_cast<std::size_t>(width / step) + 1,
                     static_cast<std::size_t>(height / step) + 1,
                     {},
                     {}};
  grid.distance.assign(grid.columns * grid.rows, std::numeric_limits<float>::infinity());
  grid.nearest.assign(grid.distance.size(), none);
  const auto first = [&](Real at) { return static_cast<std::size_t>(std::ceil((at - reach) / step)); };
  const auto last = [&](Real at) { return static_cast<std::size_t>((at + reach) / step); };
  for (std::size_t p = 0; p < positions.size() / 3; ++p) {
    const Real x = positions[3 * p] - grid.low_x, y = positions[3 * p + 1] - grid.low_y;
    for (std::size_t j = first(y); j <= std::min(last(y), grid.rows - 1); ++j)
      for (std::size_t i = first(x); i <= std::min(last(x), grid.columns - 1); ++i) {
        const auto away = static_cast<float>(std::hypot(static_cast<Real>(i) * step - x, static_cast<Real>(j) * step - y));
        const std::size_t place = j * grid.columns + i;
        if (away < grid.distance[place])
          grid.distance[place] = away, grid.nearest[place] = static_cast<Index>(p);
      }
  }
  return grid;
}

/// Places further than `covered` from any point that are joined to `place` by such places; they are marked as seen.
std::vector<std::size_t> open_around(std::size_t place, const NearestPoints& grid, Real covered, std::vector<bool>& seen)
{
  std::vector<std::size_t> found{place};
  seen[place] = true;
  for (std::size_t k = 0; k < found.size(); ++k) {
    const std::size_t i = found[k] % grid.columns, j = found[k] / grid.columns;
    const auto visit = [&](bool there, std::size_t other) {
      if (there && !seen[other] && grid.distance[other] > covered) {
        seen[other] = true;
        found.push_back(other);
      }
    };
    visit(i > 0, found[k] - 1);
    visit(i + 1 < grid.columns, found[k] + 1);
    visit(j > 0, found[k] - grid.columns);
    visit(j + 1 < grid.rows, found[k] + grid.columns);
  }
  return found;
}

}  // namespace

std::vector<Real> closing_radii(std::span<const Real> positions, Real radius)
{
  std::vector<Real> radii(positions.size() / 3, radius);
  if (radii.empty())
    return radii;
  const NearestPoints grid = nearest_points(positions, radius);
  const Real covered = radius - grid.step / 2;  // a smaller hole could lie between places
  std::vector<bool> seen(grid.distance.size());
  for (std::size_t place = 0; place < seen.size(); ++place) {
    if (seen[place] || !(grid.distance[place] > covered))
      continue;
    const auto hole = open_around(place, grid, covered, seen);  // the first one is all that is outside: the grid is wider than the points
    if (std::any_of(hole.begin(), hole.end(), [&](std::size_t at) { return grid.nearest[at] == none; }))
      continue;
    for (const std::size_t at : hole) {
      Real& mine = radii[static_cast<std::size_t>(grid.nearest[at])];
      mine = std::max(mine, static_cast<Real>(grid.distance[at]) + grid.step);  // places lie half a diagonal of a square apart at most
    }
  }
  return radii;
}

Real spacing_of(std::span<const Real> positions, int dimension)
{
  const std::size_t n = positions.size() / 3;
  if (n < 2)
    return 1;
  const auto neighbours = std::min(2 * static_cast<std::size_t>(dimension), n - 1);
  const std::size_t stride = n / sample + 1;
  std::vector<Real> means((n + stride - 1) / stride);
  parallel_for(static_cast<Index>(means.size()), [&](Index i) {
    const std::size_t p = static_cast<std::size_t>(i) * stride;
    std::vector<Real> nearest(neighbours + 1, std::numeric_limits<Real>::infinity());  // squared, a heap; the point itself is one of them
    for (std::size_t q = 0; q < n; ++q) {
      Real square = 0;
      for (std::size_t d = 0; d < 3; ++d)
        square += (positions[3 * q + d] - positions[3 * p + d]) * (positions[3 * q + d] - positions[3 * p + d]);
      if (square < nearest.front()) {
        std::pop_heap(nearest.begin(), nearest.end());
        nearest.back() = square;
        std::push_heap(nearest.begin(), nearest.end());
      }
    }
    means[static_cast<std::size_t>(i)] =
        std::accumulate(nearest.begin(), nearest.end(), Real{0}, [](Real sum, Real square) { return sum + std::sqrt(square); }) /
        static_cast<Real>(neighbours);
  });
  const auto middle = means.begin() + static_cast<std::ptrdiff_t>(means.size() / 2);
  std::nth_element(means.begin(), middle, means.end());
  return *middle > 0 ? *middle : 1;
}

}  // namespace talus
