#include "solver/boundary/boundary_conditions.hpp"

namespace talus {

template <int D>
Mat<D> BoundaryConditions<D>::free_changes(NodeOfField at, const Vec<D>& v) const
{
  constexpr Real touches = 1e-9;  // of the speed: a condition that acts leaves a normal velocity of rounding errors
  Mat<D> free = Mat<D>::Identity();
  if (!binds(at.node))
    return free;
  const NodeRule& rule = rule_of(at.node);
  if (is_held(rule))
    return Mat<D>::Zero();
  const auto take = [&](Vec<D> normal) {
    normal = free * normal;
    if (const Real length = normal.norm(); length > touches)
      free -= normal / length * (normal / length).transpose();
  };
  for (const Plane& plane : rule.two_sided)
    if (!released(plane.condition))
      take(plane.normal);
  for_each_touched(rule, at.open, [&](const Plane& plane) {
    if (std::abs(v.dot(plane.normal)) <= touches * v.norm())
      take(plane.normal);
    if (v.isZero(0))  // friction holds it
      free.setZero();
  });
  return free;
}

template <int D>
void BoundaryConditions<D>::react(Index node, const Vec<D>& impulse)
{
  if (!binds(node) || impulse.isZero(0))
    return;
  const NodeRule& rule = rule_of(node);
  if (!rule.counted)
    return;
  const Index by = is_held(rule)             ? rule.holder
                   : !rule.two_sided.empty() ? rule.two_sided.front().condition
                   : !rule.one_sided.empty() ? rule.one_sided.front().condition
                                             : none;
  if (by != none)
    pushed_[static_cast<std::size_t>(by)].add({impulse, moment<D>(rule.place, impulse)});
}

template Mat<2> BoundaryConditions<2>::free_changes(NodeOfField, const Vec<2>&) const;
template Mat<3> BoundaryConditions<3>::free_changes(NodeOfField, const Vec<3>&) const;
template void BoundaryConditions<2>::react(Index, const Vec<2>&);
template void BoundaryConditions<3>::react(Index, const Vec<3>&);

}  // namespace talus
