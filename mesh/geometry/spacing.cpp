#include "mesh/geometry/spacing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <set>

#include "core/parallel/threads.hpp"

namespace talus {

namespace {

constexpr std::size_t sample = 250;  // number of points whose neighbours are searched among all points

constexpr Real widest_hole = 2.2;         // radius of a disk that fits into a void, relative to the radius of the drawn disks
constexpr Real fineness = 8;              // grid positions per radius
constexpr Real coarsest = 0.5;            // largest distance of grid positions relative to the radius
constexpr std::size_t most_places = 4e7;  // largest number of grid positions; the grid is coarser where it would have more

/// The distance from each position of a grid to the nearest point; empty if the grid would be too coarse to show holes.
struct NearestPoints {
  Real low_x{}, low_y{}, step{};
  std::size_t columns{}, rows{};
  std::vector<float> distance;  ///< infinite where no point is near [m]
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
  if (!(step <= radius * coarsest))
    return {};
  grid.distance.assign(grid.columns * grid.rows, std::numeric_limits<float>::infinity());
  grid.nearest.assign(grid.distance.size(), none);
  const auto first = [&](Real at) { return static_cast<std::size_t>(std::ceil((at - reach) / step)); };
  const auto last = [&](Real at) { return static_cast<std::size_t>((at + reach) / step); };
  for (std::size_t p = 0; p < positions.size() / 3; ++p) {
    const Real x = positions[3 * p] - grid.low_x, y = positions[3 * p + 1] - grid.low_y;
    for (std::size_t j = first(y); j <= std::min(last(y), grid.rows - 1); ++j) {
      const Real across = static_cast<Real>(j) * step - y;
      for (std::size_t i = first(x); i <= std::min(last(x), grid.columns - 1); ++i) {
        const Real along = static_cast<Real>(i) * step - x;
        const auto square = static_cast<float>(along * along + across * across);
        const std::size_t place = j * grid.columns + i;
        if (square < grid.distance[place])
          grid.distance[place] = square, grid.nearest[place] = static_cast<Index>(p);
      }
    }
  }
  for (float& distance : grid.distance)
    distance = std::sqrt(distance);
  return grid;
}

/// An interval of a grid row whose positions are further than a given distance from any point.
struct Run {
  std::ptrdiff_t first, last;
};

std::vector<std::vector<Run>> empty_runs(const NearestPoints& grid, Real far)
{
  std::vector<std::vector<Run>> rows(grid.rows);
  for (std::size_t j = 0; j < grid.rows; ++j)
    for (std::size_t i = 0; i < grid.columns; ++i) {
      if (!(grid.distance[j * grid.columns + i] > far))
        continue;
      const auto place = static_cast<std::ptrdiff_t>(i);
      if (rows[j].empty() || rows[j].back().last + 1 < place)
        rows[j].push_back({place, place});
      rows[j].back().last = place;
    }
  return rows;
}

/// For each position of row `row`, whether it is within `reach` of the centre of an empty disk.
std::vector<bool> open_places(const NearestPoints& grid, const std::vector<std::vector<Run>>& empty, std::size_t row, Real reach)
{
  const auto columns = static_cast<std::ptrdiff_t>(grid.columns), rows = static_cast<std::ptrdiff_t>(grid.rows);
  const auto reached = static_cast<std::ptrdiff_t>(reach / grid.step), here = static_cast<std::ptrdiff_t>(row);
  std::vector<int> begun(grid.columns + 1, 0);  // disks that begin at a position minus those that ended before
  for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(0, here - reached); j <= std::min(rows - 1, here + reached); ++j) {
    const Real away = static_cast<Real>(j - here) * grid.step;
    const auto half = static_cast<std::ptrdiff_t>(std::sqrt(std::max(Real{0}, reach * reach - away * away)) / grid.step);
    for (const Run& run : empty[static_cast<std::size_t>(j)]) {
      ++begun[static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, run.first - half))];
      --begun[static_cast<std::size_t>(std::min(columns, run.last + half + 1))];
    }
  }
  std::vector<bool> open(grid.columns);
  int disks = 0;
  for (std::size_t i = 0; i < grid.columns; ++i)
    open[i] = (disks += begun[i]) > 0;
  return open;
}

}  // namespace

std::vector<Real> closing_radii(std::span<const Real> positions, Real radius)
{
  std::vector<Real> radii(positions.size() / 3, radius);
  if (radii.empty())
    return radii;
  const NearestPoints grid = nearest_points(positions, radius);
  if (grid.distance.empty())
    return radii;  // that many disks across: single points are not visible
  const Real reach = widest_hole * radius;
  const Real between = grid.step * std::numbers::sqrt2 / 2;  // distance from a grid position to the furthest point of its cell
  const Real covered = radius - between;
  const auto empty = empty_runs(grid, reach);
  for (std::size_t j = 0; j < grid.rows; ++j) {
    const std::vector<bool> open = open_places(grid, empty, j, reach);
    for (std::size_t i = 0; i < grid.columns; ++i)
      if (const std::size_t place = j * grid.columns + i; !open[i] && grid.distance[place] > covered) {
        Real& mine = radii[static_cast<std::size_t>(grid.nearest[place])];
        mine = std::max(mine, static_cast<Real>(grid.distance[place]) + between);
      }
  }
  return radii;
}

Spread::Spread(std::span<const std::int64_t> ids, std::span<const Real> areas)
{
  std::vector<Real> sorted(areas.begin(), areas.end());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  if (sorted.empty() || !(*middle > 0))
    return;
  for (std::size_t p = 0; p < areas.size(); ++p)
    of_id_.emplace(ids[p], std::sqrt(std::max(Real{0}, areas[p]) / *middle));
}

std::vector<Real> Spread::of(std::span<const std::int64_t> ids) const
{
  std::vector<Real> spread;
  spread.reserve(ids.size());
  for (const std::int64_t id : ids) {
    const auto known = of_id_.find(id);
    spread.push_back(known == of_id_.end() ? 1 : known->second);
  }
  return spread;
}

std::vector<Real> closing_radii(std::span<const Real> positions, Real radius, std::span<const Real> spread)
{
  constexpr Real levels_a_doubling = 2;  // radii that are up to a fifth too large or too small leave no hole
  std::vector<Real> radii(positions.size() / 3, radius);
  std::vector<long> levels(radii.size(), 0);
  for (std::size_t p = 0; p < levels.size(); ++p)
    if (spread[p] > 1)
      levels[p] = std::lround(levels_a_doubling * std::log2(spread[p]));
  for (const long level : std::set<long>(levels.begin(), levels.end())) {
    const std::vector<Real> closing = closing_radii(positions, radius * std::exp2(static_cast<Real>(level) / levels_a_doubling));
    for (std::size_t p = 0; p < levels.size(); ++p)
      if (levels[p] == level)
        radii[p] = closing[p];
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
    std::vector<Real> nearest(neighbours + 1, std::numeric_limits<Real>::infinity());  // heap of squared distances, own one included
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
