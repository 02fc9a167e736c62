#include "solver/rigid/rigid_contacts.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace talus {

namespace {

/// Points of a pair that are kept: enough to hold a flat face.
template <int D>
inline constexpr std::size_t most_points = D == 2 ? 2 : 6;
constexpr int most_turns = 200;
constexpr Real settled = 1e-12;      ///< change of the impulses in a turn, relative to the largest, at which turns end
constexpr Real share_parted = 0.2;   ///< of an overlap, in a step
constexpr Real overlap_left = 1e-5;  ///< that is left alone, relative to the radius
constexpr Real past_rim = 2e-3;      ///< how far beside and behind the rim of a wall something still touches it, relative to the radius

/// The deepest point and those farthest from all chosen before: a body on a face is held by the rim of the face.
template <int D>
void keep_spread(std::vector<RigidContact<D>>& points)
{
  if (points.size() <= most_points<D>)
    return;
  std::iter_swap(points.begin(), std::ranges::min_element(points, {}, &RigidContact<D>::gap));
  for (std::size_t kept = 1; kept < most_points<D>; ++kept) {
    const auto apart = [&](const RigidContact<D>& point) {
      Real least = std::numeric_limits<Real>::infinity();
      for (std::size_t k = 0; k < kept; ++k)
        least = std::min(least, (point.place - points[k].place).squaredNorm());
      return least;
    };
    const auto next = points.begin() + static_cast<std::ptrdiff_t>(kept);
    std::iter_swap(next, std::ranges::max_element(next, points.end(), {}, apart));
  }
  points.resize(most_points<D>);
}

/// Whether a centre beside the rim of an open surface is farther from it than this.  Distances of closed ones have no rim.
template <int D>
bool is_beside(const SurfaceDistance<D>& to, Real reach)
{
  return to.on_rim && std::abs(to.distance) > reach;
}

/// The distance of the centre of a ball from a wall: what is beside the rim is outside, so that a ball rolls around the rim.
template <int D>
SurfaceDistance<D> of_ball(const SurfaceDistance<D>& to)
{
  return to.on_rim && to.distance < 0 ? SurfaceDistance<D>{-to.distance, -to.normal, to.on_rim, to.rim_normal} : to;
}

/// The distance of a point of a surface from a wall.  The wall is the half space behind its facets, but ends at its rim: a point past the rim
/// and behind the plane of the facets there is outside.  Two kinds of points are exceptions, `slack` [m] being small.  Just past the rim in
/// both directions the wall goes on, as two walls that meet there at an inner angle have to hold the corner of a body.  Farther beside it but
/// hardly behind its plane nothing is felt, as another wall may go on in that plane, on which a body slides across the joint.
template <int D>
SurfaceDistance<D> of_point(const SurfaceDistance<D>& to, Real slack)
{
  if (!to.on_rim || !(to.distance < 0))
    return to;
  const Real height = to.distance * to.normal.dot(to.rim_normal);  // above the plane, <= 0
  if (-height > slack)
    return {-to.distance, -to.normal, to.on_rim, to.rim_normal};
  const Real aside = std::sqrt(std::max(Real{0}, to.distance * to.distance - height * height));
  if (aside > slack)
    return {std::numeric_limits<Real>::infinity(), to.rim_normal, to.on_rim, to.rim_normal};
  return {height, to.rim_normal, to.on_rim, to.rim_normal};
}

/// The points of the surface of a body that are no farther than `near` from another surface; only walls are open.
template <int D, class DistanceTo>
std::vector<RigidContact<D>> points_near(const RigidShape<D>& shape, const RigidState<D>& state, Real near, DistanceTo&& distance_to)
{
  std::vector<RigidContact<D>> points;
  const SurfaceDistance<D> of_centre = distance_to(state.x);
  if (of_centre.distance > shape.radius() + near || is_beside(of_centre, shape.radius() + near))
    return points;
  const auto add = [&](const Vec<D>& place, const SurfaceDistance<D>& to) {
    RigidContact<D>& point = points.emplace_back();
    point.place = place, point.normal = to.normal, point.gap = to.distance;
  };
  if (shape.is_ball()) {
    const SurfaceDistance<D> to = of_ball(of_centre);
    const Vec<D> place = state.x - shape.radius() * to.normal;
    add(place, {to.distance - shape.radius(), to.normal});
    return points;
  }
  for (const Vec<D>& sample : shape.samples()) {
    const Vec<D> place = state.x + state.in_scene(sample);
    if (const SurfaceDistance<D> to = of_point(distance_to(place), past_rim * shape.radius()); to.distance <= near)
      add(place, to);
  }
  keep_spread<D>(points);
  return points;
}

/// Where a ball touches the faces of a sheet, on whichever side its centre is; nothing beside the rim.  A small ball would pass between the
/// samples of the sheet.
template <int D>
std::vector<RigidContact<D>> point_of_ball(Real radius, const Vec<D>& centre, Real near, const SurfaceDistance<D>& to)
{
  std::vector<RigidContact<D>> points;
  if (to.on_rim || std::abs(to.distance) > radius + near)
    return points;
  RigidContact<D>& point = points.emplace_back();
  point.normal = (to.distance < 0 ? -1 : 1) * to.normal;
  point.place = centre - radius * point.normal, point.gap = std::abs(to.distance) - radius;
  return points;
}

/// How a body answers an impulse at a place.
template <int D>
struct Answer {
  Real per_mass = 0;
  Mat3 per_inertia = Mat3::Zero();
  Answer() = default;
  Answer(const RigidBody<D>& body, const RigidState<D>& state)
  {
    if (!body.is_free())
      return;
    per_mass = 1 / body.mass;
    if constexpr (D == 2)
      per_inertia(2, 2) = 1 / body.inertia(2, 2);
    else
      per_inertia = state.inertia(body).inverse();
  }
  /// The change of velocity along a unit vector by a unit impulse along it, at an arm [1/kg].
  Real along(const Vec<D>& arm, const Vec<D>& way) const
  {
    const Vec3 turning = per_inertia * moment<D>(arm, way);
    return per_mass + turned_arm<D>(turning, arm).dot(way);
  }
  void take(RigidState<D>& state, const Vec<D>& arm, const Vec<D>& impulse) const
  {
    state.v += per_mass * impulse;
    state.spin += per_inertia * moment<D>(arm, impulse);
  }
};

}  // namespace

template <int D>
std::vector<RigidContact<D>> find_contacts(const RigidScene<D>& scene, std::span<const RigidState<D>> states, Real dt)
{
  std::vector<RigidContact<D>> all;
  const auto reach = [&](std::size_t r) {
    const Real radius = scene.bodies[r].shape->radius();
    return 2 * dt * (states[r].v.norm() + states[r].spin.norm() * radius) + 1e-3 * radius;
  };
  const auto take = [&](std::vector<RigidContact<D>> points, std::size_t first, Index second, Real friction, Real sense,
                        Index wall = none) {
    for (RigidContact<D>& point : points) {
      point.first = static_cast<Index>(first), point.second = second, point.wall = wall;
      point.friction = friction, point.normal *= sense;
      all.push_back(point);
    }
  };
  for (std::size_t a = 0; a < states.size(); ++a) {
    const RigidBody<D>& body = scene.bodies[a];
    const RigidShape<D>& shape = *body.shape;
    if (body.is_free())
      for (std::size_t w = 0; w < scene.walls.size(); ++w)
        take(points_near<D>(shape, states[a], reach(a), [&](const Vec<D>& x) { return scene.walls[w].surface.distance(x); }), a, none,
             body.friction, 1, static_cast<Index>(w));
    for (std::size_t b = a + 1; b < states.size(); ++b) {
      const RigidBody<D>& other = scene.bodies[b];
      if (!body.is_free() && !other.is_free())
        continue;
      const Real near = reach(a) + reach(b), friction = std::sqrt(body.friction * other.friction);
      if ((states[a].x - states[b].x).norm() > shape.radius() + other.shape->radius() + near)
        continue;
      // Sheets have no inside: their points are sought in solids, not the other way round.
      const auto to_b = [&](const Vec<D>& x) { return states[b].distance(*other.shape, x); };
      const auto to_a = [&](const Vec<D>& x) { return states[a].distance(shape, x); };
      if (!other.shape->is_sheet() && (!other.shape->is_ball() || shape.is_ball() || shape.is_sheet()))
        take(points_near<D>(shape, states[a], near, to_b), a, static_cast<Index>(b), friction, 1);
      if (!shape.is_sheet() && (!shape.is_ball() || other.shape->is_sheet()))
        take(points_near<D>(*other.shape, states[b], near, to_a), a, static_cast<Index>(b), friction, -1);
      if (shape.is_ball() && other.shape->is_sheet())
        take(point_of_ball<D>(shape.radius(), states[a].x, near, to_b(states[a].x)), a, static_cast<Index>(b), friction, 1);
      if (shape.is_sheet() && other.shape->is_ball())
        take(point_of_ball<D>(other.shape->radius(), states[b].x, near, to_a(states[b].x)), a, static_cast<Index>(b), friction, -1);
    }
  }
  return all;
}

template <int D>
void act_on_contacts(const RigidScene<D>& scene, Real dt, std::span<RigidContact<D>> contacts, std::span<RigidState<D>> states)
{
  std::vector<Answer<D>> answers;
  for (std::size_t r = 0; r < states.size(); ++r)
    answers.emplace_back(scene.bodies[r], states[r]);
  const auto arm_of = [&](const RigidContact<D>& at, Index body) { return Vec<D>(at.place - states[static_cast<std::size_t>(body)].x); };
  const auto velocity = [&](const RigidContact<D>& at) {
    Vec<D> v = states[static_cast<std::size_t>(at.first)].velocity_at(at.place);
    if (at.second != none)
      v -= states[static_cast<std::size_t>(at.second)].velocity_at(at.place);
    return v;
  };
  const auto response = [&](const RigidContact<D>& at, const Vec<D>& way) {
    Real sum = answers[static_cast<std::size_t>(at.first)].along(arm_of(at, at.first), way);
    if (at.second != none)
      sum += answers[static_cast<std::size_t>(at.second)].along(arm_of(at, at.second), way);
    return sum;
  };
  const auto push_both = [&](const RigidContact<D>& at, const Vec<D>& impulse) {
    answers[static_cast<std::size_t>(at.first)].take(states[static_cast<std::size_t>(at.first)], arm_of(at, at.first), impulse);
    if (at.second != none)
      answers[static_cast<std::size_t>(at.second)].take(states[static_cast<std::size_t>(at.second)], arm_of(at, at.second), -impulse);
  };
  for (int turn = 0; turn < most_turns; ++turn) {
    Real change = 0, largest = 0;
    for (RigidContact<D>& at : contacts) {
      const Real wanted = -(velocity(at).dot(at.normal) + std::max(at.gap, Real{0}) / dt) / response(at, at.normal);
      const Real pressed = std::max(at.pressed + wanted, Real{0});
      push_both(at, (pressed - at.pressed) * at.normal);
      change = std::max(change, std::abs(pressed - at.pressed));
      at.pressed = pressed;
      largest = std::max(largest, pressed);
      const Vec<D> v = velocity(at), sliding = v - v.dot(at.normal) * at.normal;
      const Real speed = sliding.norm();
      if (speed > 0) {
        const Vec<D> way = sliding / speed;
        Vec<D> rubbed = at.rubbed - speed / response(at, way) * way;
        if (const Real size = rubbed.norm(), most = at.friction * at.pressed; size > most)
          rubbed *= most / size;
        push_both(at, rubbed - at.rubbed);
        change = std::max(change, (rubbed - at.rubbed).norm());
        at.rubbed = rubbed;
      }
    }
    if (change <= settled * largest)
      break;
  }
  const auto overlap_at = [&](const RigidContact<D>& at) {
    return -at.gap - overlap_left * scene.bodies[static_cast<std::size_t>(at.first)].shape->radius();
  };
  std::map<std::array<Index, 3>, int> overlaps;  // points by bodies and wall
  for (const RigidContact<D>& at : contacts)
    if (overlap_at(at) > 0)
      ++overlaps[{at.first, at.second, at.wall}];
  for (const RigidContact<D>& at : contacts) {
    const auto a = static_cast<std::size_t>(at.first);
    const Real overlap = overlap_at(at);
    if (overlap <= 0)
      continue;
    const Real first = answers[a].per_mass, second = at.second == none ? 0 : answers[static_cast<std::size_t>(at.second)].per_mass;
    const Vec<D> apart = share_parted * overlap / overlaps.at({at.first, at.second, at.wall}) / (first + second) * at.normal;
    states[a].x += first * apart;
    if (at.second != none)
      states[static_cast<std::size_t>(at.second)].x -= second * apart;
  }
}

#define TALUS_INSTANTIATE(D)                                                                                       \
  template std::vector<RigidContact<D>> find_contacts(const RigidScene<D>&, std::span<const RigidState<D>>, Real); \
  template void act_on_contacts(const RigidScene<D>&, Real, std::span<RigidContact<D>>, std::span<RigidState<D>>);
TALUS_INSTANTIATE(2)
TALUS_INSTANTIATE(3)
#undef TALUS_INSTANTIATE

}  // namespace talus
