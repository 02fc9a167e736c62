#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/contact/contact_nodes.hpp"
#include "solver/contact/exchange.hpp"

namespace talus {

namespace {

/// Sweeps over the contacts of nodes at which more than two fields may touch.
constexpr int sweeps_over_laws = 8;
/// Fields that approach no faster than this share of their speeds have met in an earlier sweep: the rest is round-off.
constexpr Real met = 1e-12;

/// The largest further impulse along a unit vector with which the sum of impulses across the normal does not exceed `most`.
template <int D>
Real left_of(Real most, const Vec<D>& rubbed, const Vec<D>& way)
{
  if (rubbed.isZero(0))
    return most;
  const Real along = rubbed.dot(way);
  return std::max(Real{0}, std::sqrt(std::max(Real{0}, along * along + most * most - rubbed.squaredNorm())) - along);
}

}  // namespace

template <int D>
void ContactNodes<D>::act(const Kick& kick, BoundaryConditions<D>& conditions, std::span<VelocityField<D>> fields,
                          ExactSums<BoundaryWork>& work)
{
  if (!any())
    return;
  for (int sweep = 0; sweep < (contacts_.laws.size() > 1 ? sweeps_over_laws : 1); ++sweep)
    for (ContactNode<D>& at : nodes_) {
      if (!at.touches)
        continue;
      const ContactLaw& law = contacts_.laws[static_cast<std::size_t>(at.law)];
      const auto n = static_cast<std::size_t>(at.node);
      const auto side = [&](Index field) {
        const Nodes<D>& nodes = fields[static_cast<std::size_t>(field)].nodes;
        return Side<D>{conditions, nodes.of_field(at.node), kick.to, nodes.sum[n].mass, nodes.motion[n].v};
      };
      const Side<D> first = side(law.first), second = side(law.second);
      const Vec<D> relative = first.v - second.v;
      const Real approach = relative.dot(at.normal);
      if (sweep > 0 && approach <= met * (first.v.norm() + second.v.norm()))
        continue;
      // Friction and cohesion are those of a step, not of a sweep.
      const auto limit = [&](Real pressure) {
        const Real most = law.friction * (at.pressed.norm() + pressure) + law.cohesion * at.area * kick.length();
        return left_of<D>(most, at.rubbed, -(relative - approach * at.normal).stableNormalized());
      };
      const Exchange<D> by = exchange(first, second, at.normal, limit);
      if (by.pressed.isZero(0))
        continue;
      at.pressed += by.pressed, at.rubbed += by.rubbed, at.sticks = by.sticks;
      const auto push = [&](Index field, const Vec<D>& impulse) {
        Nodes<D>& nodes = fields[static_cast<std::size_t>(field)].nodes;
        const Vec<D> change = impulse / nodes.sum[n].mass;
        nodes.motion[n].v += change, nodes.motion[n].change += change;
        conditions.apply(nodes.of_field(at.node), kick, nodes.sum[n].mass, nodes.motion[n], work);
      };
      const Vec<D> impulse = by.pressed + by.rubbed;
      push(law.first, impulse);
      push(law.second, -impulse);
    }
}

template <int D>
void ContactNodes<D>::hold(Real time, const BoundaryConditions<D>& conditions, std::span<VelocityField<D>> fields) const
{
  for (const ContactNode<D>& at : nodes_) {
    if (at.pressed.isZero(0))
      continue;
    const ContactLaw& law = contacts_.laws[static_cast<std::size_t>(at.law)];
    const auto n = static_cast<std::size_t>(at.node);
    Nodes<D>&first = fields[static_cast<std::size_t>(law.first)].nodes, &second = fields[static_cast<std::size_t>(law.second)].nodes;
    NodeMotion<D>&v_first = first.remapped[n], &v_second = second.remapped[n];
    if (!at.sticks && !at.rubbed.isZero(0)) {
      v_first.v = v_first.change, v_second.v = v_second.change;
      continue;
    }
    const auto side = [&](const Nodes<D>& nodes) {
      return Side<D>{conditions, nodes.of_field(at.node), time, nodes.sum[n].mass, nodes.remapped[n].v};
    };
    const auto all_or_nothing = [&](Real) { return at.sticks ? std::numeric_limits<Real>::infinity() : 0; };
    const Exchange<D> by = exchange(side(first), side(second), at.normal, all_or_nothing);
    const Vec<D> impulse = by.pressed + by.rubbed;
    v_first.v = conditions.held(first.of_field(at.node), time, v_first.v + impulse / first.sum[n].mass);
    v_second.v = conditions.held(second.of_field(at.node), time, v_second.v - impulse / second.sum[n].mass);
  }
}

template <int D>
void ContactNodes<D>::add_sums(const Mesh<D>& mesh, std::span<const VelocityField<D>> fields,
                               std::span<ExactSums<ContactSums<D>>> sums) const
{
  for (const ContactNode<D>& at : nodes_) {
    if (at.pressed.isZero(0))
      continue;
    const ContactLaw& law = contacts_.laws[static_cast<std::size_t>(at.law)];
    const auto mean_velocity = [&](Index field) -> Vec<D> {
      const NodeMotion<D>& motion = fields[static_cast<std::size_t>(field)].nodes.motion[static_cast<std::size_t>(at.node)];
      return motion.v - 0.5 * motion.change;
    };
    const Vec<D> relative = mean_velocity(law.first) - mean_velocity(law.second), impulse = at.pressed + at.rubbed;
    sums[static_cast<std::size_t>(at.law)].add(
        {impulse, moment<D>(mesh.node(at.node), impulse), at.pressed.dot(relative), at.rubbed.dot(relative)});
  }
}

#define TALUS_INSTANTIATE(D)                                                                                                      \
  template void ContactNodes<D>::act(const Kick&, BoundaryConditions<D>&, std::span<VelocityField<D>>, ExactSums<BoundaryWork>&); \
  template void ContactNodes<D>::hold(Real, const BoundaryConditions<D>&, std::span<VelocityField<D>>) const;                     \
  template void ContactNodes<D>::add_sums(const Mesh<D>&, std::span<const VelocityField<D>>, std::span<ExactSums<ContactSums<D>>>) const;
TALUS_INSTANTIATE(2)
TALUS_INSTANTIATE(3)
#undef TALUS_INSTANTIATE

}  // namespace talus
