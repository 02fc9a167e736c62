#include "io/scene/shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <utility>

namespace talus {

namespace {

using Point = std::array<Real, 2>;

Point point(const std::vector<Real>& x) { return {x[0], x[1]}; }

/// Twice the signed area of the triangle a b c, positive if it is counterclockwise.
Real turn(const Point& a, const Point& b, const Point& c) { return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]); }

/// Whether c, which lies on the line through a and b, lies between them.
bool between_ends(const Point& a, const Point& b, const Point& c)
{
  return std::min(a[0], b[0]) <= c[0] && c[0] <= std::max(a[0], b[0]) && std::min(a[1], b[1]) <= c[1] && c[1] <= std::max(a[1], b[1]);
}

/// Whether the closed segments a b and c d have a point in common.
bool meet(const Point& a, const Point& b, const Point& c, const Point& d)
{
  const Real c_side = turn(a, b, c), d_side = turn(a, b, d), a_side = turn(c, d, a), b_side = turn(c, d, b);
  if (((c_side > 0 && d_side < 0) || (c_side < 0 && d_side > 0)) && ((a_side > 0 && b_side < 0) || (a_side < 0 && b_side > 0)))
    return true;
  return (c_side == 0 && between_ends(a, b, c)) || (d_side == 0 && between_ends(a, b, d)) || (a_side == 0 && between_ends(c, d, a)) ||
         (b_side == 0 && between_ends(c, d, b));
}

/// Whether two sides cross or touch; neighbours may share their corner, but not overlap.
bool sides_collide(const std::vector<std::vector<Real>>& corners, std::size_t i, std::size_t j)
{
  const std::size_t n = corners.size();
  const Point a = point(corners[i]), b = point(corners[(i + 1) % n]), c = point(corners[j]), d = point(corners[(j + 1) % n]);
  const auto folds_back = [](const Point& from, const Point& corner, const Point& to) {
    const Real along = (from[0] - corner[0]) * (to[0] - corner[0]) + (from[1] - corner[1]) * (to[1] - corner[1]);
    return turn(from, corner, to) == 0 && along > 0;
  };
  if ((i + 1) % n == j)
    return folds_back(a, b, d);
  if ((j + 1) % n == i)
    return folds_back(c, d, b);
  return meet(a, b, c, d);
}

/// The numbers of two sides that cross or touch, if there are any.  Sides are swept from left to right, so the cost for a polygon of many
/// short sides is little more than that of sorting them.
std::optional<std::pair<std::size_t, std::size_t>> colliding_sides(const std::vector<std::vector<Real>>& corners)
{
  const std::size_t n = corners.size();
  const auto left = [&](std::size_t i) { return std::min(corners[i][0], corners[(i + 1) % n][0]); };
  const auto right = [&](std::size_t i) { return std::max(corners[i][0], corners[(i + 1) % n][0]); };
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, [&](std::size_t i, std::size_t j) { return left(i) < left(j); });
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t m = k + 1; m < n && left(order[m]) <= right(order[k]); ++m)
      if (sides_collide(corners, order[k], order[m]))
        return std::pair(std::min(order[k], order[m]), std::max(order[k], order[m]));
  return std::nullopt;
}

/// The position along the axis as a fraction of its length, and the distance from the axis [m].
std::array<Real, 2> along_axis(const Cylinder& cylinder, std::span<const Real> x)
{
  Real length2 = 0, along = 0, distance2 = 0;
  for (std::size_t d = 0; d < 3; ++d) {
    const Real axis = cylinder.to[d] - cylinder.from[d], r = x[d] - cylinder.from[d];
    length2 += axis * axis;
    along += axis * r;
    distance2 += r * r;
  }
  return {along / length2, std::sqrt(std::max<Real>(0, distance2 - along * along / length2))};
}

bool holds(const Box& box, std::span<const Real> x)
{
  for (std::size_t d = 0; d < x.size(); ++d)
    if (x[d] < box.low[d] || x[d] > box.high[d])
      return false;
  return true;
}

bool holds(const Sphere& sphere, std::span<const Real> x)
{
  Real distance2 = 0;
  for (std::size_t d = 0; d < x.size(); ++d)
    distance2 += (x[d] - sphere.centre[d]) * (x[d] - sphere.centre[d]);
  return distance2 <= sphere.radius * sphere.radius;
}

bool holds(const Cylinder& cylinder, std::span<const Real> x)
{
  const auto [share, distance] = along_axis(cylinder, x);
  return share >= 0 && share <= 1 && distance <= cylinder.radius;
}

enum class WhereInPolygon : std::uint8_t { inside, on_a_side, outside };

/// Counts the sides that a ray to the right crosses; corners belong to the side above them.
WhereInPolygon place_in(const std::vector<std::vector<Real>>& corners, const Point& p)
{
  bool inside = false;
  const std::size_t n = corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Point a = point(corners[i]), b = point(corners[(i + 1) % n]);
    const Real side = turn(a, b, p);
    if (side == 0 && between_ends(a, b, p))
      return WhereInPolygon::on_a_side;
    if ((a[1] <= p[1]) != (b[1] <= p[1]) && (side > 0) == (b[1] > a[1]))
      inside = !inside;
  }
  return inside ? WhereInPolygon::inside : WhereInPolygon::outside;
}

bool holds(const Polygon& polygon, std::span<const Real> x)
{
  if (x.size() == 3 && (x[2] < polygon.extrude[0] || x[2] > polygon.extrude[1]))
    return false;
  const Point p{x[0], x[1]};
  return place_in(polygon.points, p) != WhereInPolygon::outside &&
         std::ranges::none_of(polygon.holes, [&](const auto& hole) { return place_in(hole, p) == WhereInPolygon::inside; });
}

bool holds(const Ring& ring, std::span<const Real> x)
{
  Real distance2 = 0;
  for (std::size_t d = 0; d < x.size(); ++d)
    distance2 += (x[d] - ring.centre[d]) * (x[d] - ring.centre[d]);
  return distance2 <= ring.radius * ring.radius && distance2 >= ring.inner_radius * ring.inner_radius;
}

bool holds(const SimpleShape& shape, std::span<const Real> x)
{
  return std::visit([&](const auto& s) { return holds(s, x); }, shape);
}
bool holds(const Difference& difference, std::span<const Real> x)
{
  return holds(difference.of, x) && std::ranges::none_of(difference.without, [&](const SimpleShape& part) { return holds(part, x); });
}
bool holds(const Union& all, std::span<const Real> x)
{
  return std::ranges::any_of(all.of, [&](const SimpleShape& part) { return holds(part, x); });
}
bool holds(const Intersection& all, std::span<const Real> x)
{
  return std::ranges::all_of(all.of, [&](const SimpleShape& part) { return holds(part, x); });
}

/// Adds an error unless the corners are those of a simple polygon; `key` is their name.  Returns whether they are.
bool check_ring(const std::string& key, const std::vector<std::vector<Real>>& points, std::vector<std::string>& problems)
{
  const auto complain = [&](std::string what) {
    problems.push_back(std::move(what));
    return false;
  };
  const std::string of_hole = key == "points" ? "" : key + ": ";
  if (points.size() < 3)
    return complain(fmt::format("{}a polygon needs at least 3 points, not {}", of_hole, points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].size() != 2)
      return complain(fmt::format("{}[{}] has {} numbers, not 2", key, i, points[i].size()));
  Real area = 0, scale = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point a = point(points[i]), b = point(points[(i + 1) % points.size()]), origin = point(points[0]);
    if (a == b)
      return complain(i + 1 < points.size() ? fmt::format("{0}[{1}] and {0}[{2}] are the same", key, i, i + 1)
                                            : of_hole + "the last point repeats the first: the polygon closes by itself");
    area += turn(origin, a, b) / 2;
    scale = std::max({scale, std::abs(a[0] - origin[0]), std::abs(a[1] - origin[1])});
  }
  if (std::abs(area) <= 1e-12 * scale * scale)  // round-off of the sum, relative to the bounding box
    return complain(of_hole + "the polygon has no area");
  if (const auto sides = colliding_sides(points))
    return complain(fmt::format("the side after {0}[{1}] meets the side after {0}[{2}]", key, sides->first, sides->second));
  return true;
}

/// Whether a side of one ring has a point in common with a side of the other.
bool rings_meet(const std::vector<std::vector<Real>>& first, const std::vector<std::vector<Real>>& second)
{
  for (std::size_t i = 0; i < first.size(); ++i)
    for (std::size_t j = 0; j < second.size(); ++j)
      if (meet(point(first[i]), point(first[(i + 1) % first.size()]), point(second[j]), point(second[(j + 1) % second.size()])))
        return true;
  return false;
}

void check_holes(const Polygon& polygon, std::vector<std::string>& problems)
{
  for (std::size_t h = 0; h < polygon.holes.size(); ++h) {
    const auto& hole = polygon.holes[h];
    if (!check_ring(fmt::format("holes[{}]", h), hole, problems))
      return;
    if (rings_meet(hole, polygon.points) || place_in(polygon.points, point(hole.front())) != WhereInPolygon::inside)
      return problems.push_back(fmt::format("holes[{}] does not lie inside the polygon", h));
    for (std::size_t other = 0; other < h; ++other)
      if (rings_meet(hole, polygon.holes[other]) || place_in(polygon.holes[other], point(hole.front())) == WhereInPolygon::inside ||
          place_in(hole, point(polygon.holes[other].front())) == WhereInPolygon::inside)
        return problems.push_back(fmt::format("holes[{}] and holes[{}] overlap or touch", other, h));
  }
}

}  // namespace

void check_corners(const std::vector<Real>& low, const std::vector<Real>& high, std::vector<std::string>& problems)
{
  for (std::size_t d = 0; d < std::min({low.size(), high.size(), std::size_t{3}}); ++d)
    if (!(low[d] < high[d]))
      problems.push_back(fmt::format("low must be smaller than high along {}: {} and {}", "xyz"[d], low[d], high[d]));
}

void Box::check(std::vector<std::string>& problems) const { check_corners(low, high, problems); }

void Cylinder::check(std::vector<std::string>& problems) const
{
  if (from == to)
    problems.push_back("the end faces have the same centre");
}

void Polygon::check(std::vector<std::string>& problems) const
{
  if (check_ring("points", points, problems))
    check_holes(*this, problems);
  if (!sides.empty() && sides.size() != points.size())
    problems.push_back(fmt::format("sides needs a name for each of the {} sides, not {}", points.size(), sides.size()));
  for (const std::string& side : sides)
    if (side.empty() || side == "boundary" || side.starts_with("hole_"))
      return problems.push_back(fmt::format("\"{}\" cannot be the name of a side: boundary and hole_i are groups of their own", side));
  if (!extrude.empty() && extrude.size() != 2)
    problems.push_back(fmt::format("extrude needs 2 numbers [z from, z to], not {}", extrude.size()));
  else if (!extrude.empty() && !(extrude[0] < extrude[1]))
    problems.push_back(fmt::format("extrude must grow: {} and {}", extrude[0], extrude[1]));
}

void Ring::check(std::vector<std::string>& problems) const
{
  if (!(inner_radius < radius))
    problems.push_back(fmt::format("inner_radius must be smaller than radius: {} and {}", inner_radius, radius));
}

bool contains(const Shape& shape, std::span<const Real> x) noexcept
{
  return std::visit([&](const auto& s) { return holds(s, x); }, shape);
}

}  // namespace talus
