#include "mesh/geometry/plan_grid.hpp"

#include <algorithm>
#include <cmath>

namespace talus {

namespace {

/// Cells along one axis that an interval meets, counted from 0, and the fraction of the interval in each.
struct Line {
  Index first;
  std::vector<Real> share;
};

/// Distributes [place - side/2, place + side/2] over n cells of width d, the first of which starts at `begin`.
Line line_of(Real place, Real side, Real begin, Real d, Index n)
{
  const Real low = std::clamp((place - side / 2 - begin) / d, Real{0}, Real(n)),
             high = std::clamp((place + side / 2 - begin) / d, Real{0}, Real(n));
  const Index first = std::clamp(static_cast<Index>(low), Index{0}, n - 1);
  if (!(high > low))
    return {first, {1}};
  Line line{first, {}};
  for (Index c = first; c < n && (c == first || c < high); ++c)
    line.share.push_back((std::min(high, Real(c) + 1) - std::max(low, Real(c))) / (high - low));
  return line;
}

}  // namespace

void spread(const PlanGrid& grid, const std::array<Real, 2>& place, Real side, std::vector<CellShare>& shares)
{
  shares.clear();
  const Line x = line_of(place[0], side, grid.west, grid.dx, grid.columns);
  const Line y = grid.rows > 1 ? line_of(place[1], side, grid.south, grid.dy, grid.rows) : Line{0, {1}};
  for (std::size_t j = 0; j < y.share.size(); ++j)
    for (std::size_t i = 0; i < x.share.size(); ++i)
      shares.push_back({grid.cell(x.first + static_cast<Index>(i), y.first + static_cast<Index>(j)), x.share[i] * y.share[j]});
}

Real sampled(const PlanGrid& grid, const std::vector<Real>& values, const std::array<Real, 2>& place)
{
  const Real x = (place[0] - grid.west) / grid.dx - 0.5, y = grid.rows > 1 ? (place[1] - grid.south) / grid.dy - 0.5 : 0;
  const auto clamped = [](Real at, Index n) { return static_cast<Index>(std::clamp(std::round(at), Real{0}, static_cast<Real>(n - 1))); };
  const Real nearest = values[grid.cell(clamped(x, grid.columns), clamped(y, grid.rows))];
  if (std::isnan(nearest))
    return nearest;
  Real sum = 0, weight = 0;
  for (const Real row : {std::floor(y), std::floor(y) + 1})
    for (const Real column : {std::floor(x), std::floor(x) + 1}) {
      const Real share = (1 - std::abs(x - column)) * (1 - std::abs(y - row));
      const Real value = values[grid.cell(clamped(column, grid.columns), clamped(row, grid.rows))];
      if (share > 0 && !std::isnan(value))
        sum += share * value, weight += share;
    }
  return weight > 0 ? sum / weight : nearest;
}

}  // namespace talus
