#include "app/setup/body_sides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/setup/setup.hpp"

namespace talus {

namespace {

/// A face of a box: axis `k`, at its upper or lower end.
template <int D>
SidePiece<D> face_of(const Box& box, int k, bool upper)
{
  const Vec<D> low = vector_of<D>(box.low), high = vector_of<D>(box.high);
  const Vec<D> normal = (upper ? 1 : -1) * Vec<D>::Unit(k);
  const auto near = [=](const Vec<D>& x) -> NearSide<D> {
    Vec<D> away = (x - x.cwiseMax(low).cwiseMin(high)).eval();
    away[k] = x[k] - (upper ? high[k] : low[k]);
    return {away.norm(), normal, normal};
  };
  return {near, [depth = high[k] - low[k]](Real far) { return std::min(far, depth); }};
}

/// A sphere, or a cylinder about `axis` (a unit vector; zero for a sphere) through the centre; `outwards` where the body lies inside.
template <int D>
SidePiece<D> round_piece(const Vec<D>& centre, const Vec<D>& axis, Real radius, bool outwards, Real depth)
{
  const bool is_sphere = axis.isZero(0) && D == 3;
  const auto near = [=](const Vec<D>& x) -> NearSide<D> {
    Vec<D> r = x - centre;
    r -= r.dot(axis) * axis;
    const Real distance = r.norm();
    constexpr Real least = 0.1;  // of the radius: next to the centre there is no direction, and no load reaches there
    if (distance < least * radius)
      return {radius, Vec<D>::Zero(), Vec<D>::Zero()};
    const Vec<D> normal = (outwards ? 1 : -1) * r / distance;
    const Real spread = radius / distance;
    return {std::abs(distance - radius), normal, (is_sphere ? spread * spread : spread) * normal};
  };
  return {near, [depth](Real far) { return std::min(far, depth); }};
}

/// An end face of a cylinder, with its outward normal.
template <int D>
SidePiece<D> end_of(const Vec<D>& centre, const Vec<D>& normal, Real radius, Real depth)
{
  const auto near = [=](const Vec<D>& x) -> NearSide<D> {
    const Real below = -(x - centre).dot(normal), aside = (x - centre + below * normal).norm() - radius;
    return {std::hypot(below, std::max(aside, Real{0})), normal, normal};
  };
  return {near, [depth](Real far) { return std::min(far, depth); }};
}

using Plane = Eigen::Matrix<Real, 2, 1>;

/// The corners of an outline, with the directions of its sides.
struct Outline {
  std::vector<Plane> corner;
  bool body_on_left = true;  ///< of the sides, as they go

  Outline(const std::vector<std::vector<Real>>& points, bool is_hole)
  {
    Real area = 0;
    for (const std::vector<Real>& p : points)
      corner.emplace_back(p[0], p[1]);
    for (std::size_t i = 0; i < corner.size(); ++i) {
      const Plane a = corner[i] - corner[0], b = next(i) - corner[0];
      area += a[0] * b[1] - a[1] * b[0];
    }
    body_on_left = (area > 0) != is_hole;
  }
  const Plane& next(std::size_t i) const { return corner[(i + 1) % corner.size()]; }
  std::size_t before(std::size_t i) const { return (i + corner.size() - 1) % corner.size(); }
  Plane along(std::size_t i) const { return (next(i) - corner[i]).normalized(); }
  Plane inwards(std::size_t i) const
  {
    const Plane t = along(i);
    return body_on_left ? Plane(-t[1], t[0]) : Plane(t[1], -t[0]);
  }
  Real length(std::size_t i) const { return (next(i) - corner[i]).norm(); }

  /// The slope, along side i per depth, of the column at its beginning or end: along a side beside it that is not loaded, so that nothing acts
  /// there, and halfway between two loaded sides.
  Real lean(std::size_t i, bool at_end, bool other_is_loaded) const
  {
    const std::size_t other = at_end ? (i + 1) % corner.size() : before(i);
    const Plane beside = at_end ? along(other) : Plane(-along(other));
    Plane column = inwards(i);
    if (other_is_loaded)
      column += inwards(other);
    else if (beside.dot(column) > 0)
      column = beside;
    constexpr Real steepest = 3;  // the columns of sides that meet at less than 18 degrees
    const Real depth = column.dot(inwards(i));
    return depth > 0 ? std::clamp(column.dot(along(i)) / depth, -steepest, steepest) : 0;
  }
};

/// Side i of an outline; in 3-D with `heights` between which it stands.  Columns of the carrier field stand on it: they lean as their ends do
/// and become narrower or wider with depth, and the field with them.
template <int D>
SidePiece<D> side_of_outline(const Shape& shape, const Outline& outline, std::size_t i, bool loaded_before, bool loaded_behind,
                             const std::vector<Real>& heights)
{
  const Plane origin = outline.corner[i], along = outline.along(i), inwards = outline.inwards(i);
  const Real length = outline.length(i), first = outline.lean(i, false, loaded_before), last = outline.lean(i, true, loaded_behind);
  const Real widening = (last - first) / length;
  constexpr Real narrowest = 0.3;  // of their width
  const auto in_space = [](const Plane& plane) {
    Vec<D> v = Vec<D>::Zero();
    v.template head<2>() = plane;
    return v;
  };
  const auto near = [=](const Vec<D>& x) -> NearSide<D> {
    const Plane r = x.template head<2>() - origin;
    const Real s = r.dot(along), depth = r.dot(inwards), aside = std::max({s - length, -s, Real{0}}), width = 1 + widening * depth;
    NearSide<D> side{std::hypot(depth, aside), in_space(-inwards), Vec<D>::Zero()};
    const Real foot = width >= narrowest ? (s - depth * first) / width : -1;
    if (foot >= 0 && foot <= length)
      side.carrier = in_space((-inwards - (first + widening * foot) * along) / width);
    return side;
  };
  const auto thickness = [=](Real far) {
    if (widening < 0)
      far = std::min(far, (narrowest - 1) / widening);
    constexpr int columns = 9, steps = 64;
    for (int k = 0; k < columns; ++k) {
      const Real s = (k + 0.5) / columns * length, lean = first + widening * s;
      for (int step = 1; step <= steps; ++step) {
        const Real depth = far * step / steps;
        Vec<D> x = in_space(origin + (s + depth * lean) * along + depth * inwards);
        if constexpr (D == 3)
          x[2] = (heights[0] + heights[1]) / 2;
        if (!contains(shape, std::span(x.data(), D))) {
          far = depth;
          break;
        }
      }
    }
    return far;
  };
  return {near, thickness};
}

/// The sides of an outline that `is_loaded` selects by number.
template <int D, class IsLoaded>
std::vector<SidePiece<D>> sides_of_outline(const Shape& shape, const Outline& outline, const std::vector<Real>& heights,
                                           IsLoaded&& is_loaded)
{
  std::vector<SidePiece<D>> pieces;
  const std::size_t n = outline.corner.size();
  for (std::size_t i = 0; i < n; ++i)
    if (is_loaded(i))
      pieces.push_back(side_of_outline<D>(shape, outline, i, is_loaded(outline.before(i)), is_loaded((i + 1) % n), heights));
  return pieces;
}

/// Calls f(name, make) for each side of a shape other than its whole surface; make() is the side.
template <int D, class F>
void for_each_side(const Shape& shape, F&& f)
{
  if (const auto* box = std::get_if<Box>(&shape))
    for (int k = 0; k < D; ++k)
      for (const bool upper : {false, true})
        f(fmt::format("{}_{}", "xyz"[k], upper ? "max" : "min"), [=] { return BodySide<D>{.pieces = {face_of<D>(*box, k, upper)}}; });
  if (const auto* ring = std::get_if<Ring>(&shape))
    for (const bool outer : {false, true})
      f(std::string(outer ? "outer" : "inner"), [=] {
        return BodySide<D>{.is_closed = true,
                           .pieces = {round_piece<D>(vector_of<D>(ring->centre), Vec<D>::Zero(), outer ? ring->radius : ring->inner_radius,
                                                     outer, ring->radius - ring->inner_radius)}};
      });
  if constexpr (D == 3)
    if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
      const Vec<D> from = vector_of<D>(cylinder->from), to = vector_of<D>(cylinder->to), axis = (to - from).normalized();
      const Real length = (to - from).norm(), radius = cylinder->radius;
      f(std::string("from"), [=] { return BodySide<D>{.pieces = {end_of<D>(from, -axis, radius, length)}}; });
      f(std::string("to"), [=] { return BodySide<D>{.pieces = {end_of<D>(to, axis, radius, length)}}; });
      f(std::string("mantle"), [=] { return BodySide<D>{.pieces = {round_piece<D>(from, axis, radius, true, radius)}}; });
    }
  if (const auto* polygon = std::get_if<Polygon>(&shape)) {
    std::vector<std::string> names = polygon->sides;
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    for (const std::string& name : names)
      f(name, [=, &shape] {
        return BodySide<D>{.pieces = sides_of_outline<D>(shape, Outline(polygon->points, false), polygon->extrude,
                                                         [&](std::size_t i) { return polygon->sides[i] == name; })};
      });
    for (std::size_t h = 0; h < polygon->holes.size(); ++h)
      f(fmt::format("hole_{}", h + 1), [=, &shape] {
        return BodySide<D>{
            .is_closed = D == 2,
            .pieces = sides_of_outline<D>(shape, Outline(polygon->holes[h], true), polygon->extrude, [](std::size_t) { return true; })};
      });
    if constexpr (D == 3)
      for (const bool upper : {false, true})
        f(std::string(upper ? "z_max" : "z_min"), [=] {
          const Real z = polygon->extrude[upper ? 1 : 0], depth = polygon->extrude[1] - polygon->extrude[0];
          const Vec<D> normal = (upper ? 1 : -1) * Vec<D>::Unit(2);
          const auto near = [=](const Vec<D>& x) -> NearSide<D> { return {std::abs(z - x[2]), normal, normal}; };
          return BodySide<D>{.pieces = {{near, [depth](Real far) { return std::min(far, depth); }}}};
        });
  }
}

}  // namespace

template <int D>
std::vector<std::string> side_names(const Shape& shape)
{
  std::vector<std::string> names{"boundary"};
  for_each_side<D>(shape, [&](const std::string& name, auto&&) { names.push_back(name); });
  return names;
}

template <int D>
std::optional<BodySide<D>> side_of(const Shape& shape, std::string_view name)
{
  if (name == "boundary")
    return BodySide<D>{.is_whole = true, .is_closed = true, .pieces = {}};
  std::optional<BodySide<D>> side;
  for_each_side<D>(shape, [&](const std::string& one, auto&& make) {
    if (one == name)
      side = make();
  });
  return side;
}

template std::vector<std::string> side_names<2>(const Shape&);
template std::vector<std::string> side_names<3>(const Shape&);
template std::optional<BodySide<2>> side_of<2>(const Shape&, std::string_view);
template std::optional<BodySide<3>> side_of<3>(const Shape&, std::string_view);

}  // namespace talus
