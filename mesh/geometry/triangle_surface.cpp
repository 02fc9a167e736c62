#include "mesh/geometry/triangle_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace talus {

namespace {

constexpr Real nowhere = std::numeric_limits<Real>::quiet_NaN();

/// The triangles sorted into the squares of a grid over the plan that their bounding boxes touch; there are about as many squares as
/// triangles.
class TriangleGrid {
 public:
  explicit TriangleGrid(TriangleSheet sheet);
  Real height(const std::array<Real, 2>& place) const;

 private:
  struct Squares {
    Index west, south, east, north;
  };
  Index square(Real x, int axis) const
  {
    return std::clamp(static_cast<Index>((x - low_[static_cast<std::size_t>(axis)]) / spacing_), Index{0},
                      count_[static_cast<std::size_t>(axis)] - 1);
  }
  Squares squares_of(const std::array<Index, 3>& triangle) const;
  template <class F>
  void for_squares(const Squares& s, F&& f) const
  {
    for (Index row = s.south; row <= s.north; ++row)
      for (Index column = s.west; column <= s.east; ++column)
        f(static_cast<std::size_t>(row) * static_cast<std::size_t>(count_[0]) + static_cast<std::size_t>(column));
  }
  Real height(const std::array<Real, 2>& place, const std::array<Index, 3>& triangle) const;
  const std::array<Real, 3>& corner(Index c) const { return sheet_.corners[static_cast<std::size_t>(c)]; }

  TriangleSheet sheet_;
  std::array<Real, 2> low_{}, high_{};
  std::array<Index, 2> count_{1, 1};
  Real spacing_ = 1;
  std::vector<std::size_t> first_;  // first entry of each square in members_, and the end of the last
  std::vector<std::size_t> members_;
};

TriangleGrid::TriangleGrid(TriangleSheet sheet) : sheet_(std::move(sheet))
{
  low_.fill(std::numeric_limits<Real>::infinity());
  high_.fill(-std::numeric_limits<Real>::infinity());
  for (const auto& triangle : sheet_.triangles)
    for (const Index c : triangle)
      for (std::size_t d = 0; d < 2; ++d) {
        low_[d] = std::min(low_[d], corner(c)[d]);
        high_[d] = std::max(high_[d], corner(c)[d]);
      }
  if (sheet_.triangles.empty())
    return;
  const Real wide = high_[0] - low_[0], deep = high_[1] - low_[1], count = static_cast<Real>(sheet_.triangles.size());
  // If the triangles form a strip without width, the spacing is that along the strip.
  spacing_ = std::max({std::sqrt(wide * deep / count), std::max(wide, deep) / count, std::numeric_limits<Real>::min()});
  count_ = {static_cast<Index>(wide / spacing_) + 1, static_cast<Index>(deep / spacing_) + 1};
  first_.assign(static_cast<std::size_t>(count_[0]) * static_cast<std::size_t>(count_[1]) + 1, 0);
  for (const auto& triangle : sheet_.triangles)
    for_squares(squares_of(triangle), [&](std::size_t s) { ++first_[s + 1]; });
  for (std::size_t s = 1; s < first_.size(); ++s)
    first_[s] += first_[s - 1];
  members_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t t = 0; t < sheet_.triangles.size(); ++t)
    for_squares(squares_of(sheet_.triangles[t]), [&](std::size_t s) { members_[next[s]++] = t; });
}

TriangleGrid::Squares TriangleGrid::squares_of(const std::array<Index, 3>& triangle) const
{
  const auto [a, b, c] = triangle;
  const auto [west, east] = std::minmax({corner(a)[0], corner(b)[0], corner(c)[0]});
  const auto [south, north] = std::minmax({corner(a)[1], corner(b)[1], corner(c)[1]});
  return {square(west, 0), square(south, 1), square(east, 0), square(north, 1)};
}

Real TriangleGrid::height(const std::array<Real, 2>& place, const std::array<Index, 3>& triangle) const
{
  const auto &a = corner(triangle[0]), &b = corner(triangle[1]), &c = corner(triangle[2]);
  const Real twice_area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
  const Real size = std::max({std::abs(b[0] - a[0]), std::abs(b[1] - a[1]), std::abs(c[0] - a[0]), std::abs(c[1] - a[1])});
  constexpr Real flat = 1e-12, slack = 1e-9;  // slack: a position on a common edge is always found in a triangle
  if (std::abs(twice_area) <= flat * size * size)
    return nowhere;
  const Real of_b = ((place[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (place[1] - a[1])) / twice_area;
  const Real of_c = ((b[0] - a[0]) * (place[1] - a[1]) - (place[0] - a[0]) * (b[1] - a[1])) / twice_area;
  if (of_b < -slack || of_c < -slack || of_b + of_c > 1 + slack)
    return nowhere;
  return a[2] + of_b * (b[2] - a[2]) + of_c * (c[2] - a[2]);
}

Real TriangleGrid::height(const std::array<Real, 2>& place) const
{
  const Real slack = 1e-9 * spacing_;
  for (std::size_t d = 0; d < 2; ++d)
    if (!(place[d] >= low_[d] - slack && place[d] <= high_[d] + slack))
      return nowhere;
  Real highest = nowhere;
  const std::size_t s =
      static_cast<std::size_t>(square(place[1], 1)) * static_cast<std::size_t>(count_[0]) + static_cast<std::size_t>(square(place[0], 0));
  for (std::size_t m = first_[s]; m < first_[s + 1]; ++m)
    if (const Real z = height(place, sheet_.triangles[members_[m]]); !(z <= highest))
      highest = std::isnan(z) ? highest : z;
  return highest;
}

}  // namespace

Surface surface_of(TriangleSheet sheet)
{
  return [grid = std::make_shared<const TriangleGrid>(std::move(sheet))](const std::array<Real, 2>& place) { return grid->height(place); };
}

}  // namespace talus
