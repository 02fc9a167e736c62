#pragma once
// The impulses that two masses at one place exchange.
#include <algorithm>

#include "solver/boundary/boundary_conditions.hpp"

namespace talus {

/// A mass at a node in an exchange of impulses.
template <int D>
struct Side {
  const BoundaryConditions<D>& conditions;
  NodeOfField at;
  Real time;
  Real mass;
  Vec<D> v;
  /// How much an impulse along a unit vector changes the velocity along it, per impulse [1/kg]; `push` is a change of velocity of that
  /// direction and of the size expected.  Boundary conditions hold what they hold.
  Real per_impulse(const Vec<D>& push) const
  {
    if (!conditions.binds(at.node))
      return 1 / mass;
    const Vec<D> change = conditions.held(at, time, v + push) - v;
    return std::max(Real{0}, change.dot(push) / push.squaredNorm()) / mass;
  }
};

/// What two masses exchange that move towards each other: impulses on the first one.
template <int D>
struct Exchange {
  Vec<D> pressed = Vec<D>::Zero(), rubbed = Vec<D>::Zero();
  bool sticks = false;
};

/// `limit(pressure impulse)` is the largest tangential impulse.
template <int D, class Limit>
Exchange<D> exchange(Side<D> first, Side<D> second, const Vec<D>& normal, Limit&& limit)
{
  Exchange<D> result;
  const Real approach = (first.v - second.v).dot(normal);
  if (!(approach > 0))
    return result;
  const Real response = first.per_impulse(-approach * normal) + second.per_impulse(approach * normal);
  if (!(response > 0))
    return result;
  const Real pressure = approach / response;
  result.pressed = -pressure * normal;
  const Vec<D> relative = first.v - second.v, sliding = relative - approach * normal;
  const Real speed = sliding.norm(), most = limit(pressure);
  if (!(speed > 0) || !(most > 0)) {
    result.sticks = most > 0;
    return result;
  }
  const Real along = first.per_impulse(-sliding) + second.per_impulse(sliding);
  const Real wanted = along > 0 ? speed / along : 0;
  result.sticks = wanted <= most;
  result.rubbed = -std::min(wanted, most) / speed * sliding;
  return result;
}

}  // namespace talus
