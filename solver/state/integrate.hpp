#pragma once
// The equation of motion of the nodes.
#include "core/parallel/threads.hpp"
#include "mesh/mesh.hpp"
#include "solver/state/node_work.hpp"
#include "solver/state/nodes.hpp"

namespace talus {

/// Local non-viscous damping [Cundall 1987]: a force against the motion of a node, in each component the fraction `damping` of its net
/// force.  Not used for nodes with a boundary condition.  `net` may be a force or an acceleration.
template <int D>
Vec<D> damping_of(const Vec<D>& net, const Vec<D>& v_old, Real damping) noexcept
{
  return -damping * net.cwiseAbs().cwiseProduct(v_old.cwiseSign());
}

/// Integrates v <- v + kick (f/m + g); forces act over `kick` [s], from the time of the old velocities to that of the new ones.
template <int D>
void integrate(const Vec<D>& gravity, Real kick, Nodes<D>& nodes)
{
  nodes.gravity = gravity, nodes.kick = kick;
  nodes.in_use.for_each([&](Index n) {
    const auto i = static_cast<std::size_t>(n);
    NodeMotion<D>& motion = nodes.motion[i];
    if (!nodes.active[i]) {
      motion = NodeMotion<D>{};
      return;
    }
    const NodeSum<D>& sum = nodes.sum[i];
    const Vec<D> v_old = sum.momentum / sum.mass;
    motion.change = kick * (sum.force / sum.mass + gravity);
    motion.v = v_old + motion.change;
  });
}

/// The net accelerations of the nodes, boundary conditions included; zero for nodes of small mass.
template <int D>
void find_net_acceleration(Nodes<D>& nodes)
{
  nodes.felt.resize(nodes.sum.size());
  nodes.in_use.for_each([&](Index n) {
    const auto i = static_cast<std::size_t>(n);
    nodes.felt[i] = nodes.motion[i].change / nodes.kick;
  });
}

/// Damps nodes without boundary conditions by the part of their net acceleration that acts on particles.
template <int D>
void damp(Real damping, Nodes<D>& nodes)
{
  nodes.in_use.for_each([&](Index n) {
    const auto i = static_cast<std::size_t>(n);
    if (!nodes.active[i] || nodes.bound[i])
      return;
    const Vec<D> change = nodes.kick * damping_of<D>(nodes.felt[i], nodes.sum[i].momentum / nodes.sum[i].mass, damping);
    nodes.motion[i].change += change;
    nodes.motion[i].v += change;
  });
}

/// Adds the work of gravity and damping and the kinetic energies of one node, after boundary conditions have acted.
template <int D>
NodeWork<D> node_work(Real damping, const Mesh<D>& mesh, const Nodes<D>& nodes, Index n)
{
  const auto i = static_cast<std::size_t>(n);
  NodeWork<D> work;
  if (!nodes.active[i])
    return work;
  const NodeSum<D>& sum = nodes.sum[i];
  const Vec<D> v_old = sum.momentum / sum.mass, v = nodes.motion[i].v, v_mid = 0.5 * (v_old + v);
  work.kinetic_before = 0.5 * sum.mass * v_old.squaredNorm();
  work.kinetic_after = 0.5 * sum.mass * v.squaredNorm();
  work.mass = sum.mass;
  work.first_moment = sum.mass * mesh.node(n);
  work.turned = moment<D>(mesh.node(n), sum.mass * v - sum.momentum);
  work.gravity = nodes.kick * sum.mass * nodes.gravity.dot(v_mid);
  if (damping > 0 && !nodes.bound[i]) {
    const Vec<D> brake = nodes.kick * sum.mass * damping_of<D>(nodes.felt[i], v_old, damping);
    work.damping = brake.dot(v_mid);
    work.damped = ForceAndMoment<D>::at(mesh.node(n), brake);
  }
  return work;
}

/// The work [J] of forces in the part of the new velocity that the remap removes.  Forces act on the mean of old and new velocity, and
/// bodies strain by remapped velocities, which are the old ones of the next step; so half of the work of forces in the removed part
/// corresponds to no strain.
template <int D>
Real remap_work(const Nodes<D>& nodes, Index n, const Vec<D>& force)
{
  const auto i = static_cast<std::size_t>(n);
  return nodes.active[i] ? 0.5 * nodes.kick * force.dot(nodes.remapped[i].change - nodes.remapped[i].v) : 0;
}

/// The work [J] of a force [N] at a node over a step: impulse times the mean of old and new velocity.
template <int D>
Real work_over_step(const Nodes<D>& nodes, Index n, const Vec<D>& force) noexcept
{
  const auto i = static_cast<std::size_t>(n);
  return nodes.kick * force.dot(nodes.motion[i].v - 0.5 * nodes.motion[i].change);
}

/// That of loads on surfaces.
template <int D>
Real surface_work(const Nodes<D>& nodes, Index n) noexcept
{
  return work_over_step<D>(nodes, n, nodes.surface_loads[static_cast<std::size_t>(n)]);
}

/// Adds the energies at one node.  In stages that seek equilibrium the net force is the one in `felt`.
template <int D>
Balance balance_at(bool felt, const Nodes<D>& nodes, Index n)
{
  const auto i = static_cast<std::size_t>(n);
  if (!nodes.active[i])
    return {};
  const NodeSum<D>& sum = nodes.sum[i];
  const Vec<D> change = nodes.motion[i].change / nodes.kick;
  const Real reaction = nodes.bound[i] ? (sum.mass * (change - nodes.gravity) - sum.force).norm() : 0;
  return {sum.mass * (felt ? nodes.felt[i] : change).norm(), sum.mass * nodes.gravity.norm(), reaction};
}

/// The unbalanced force: net force over gravity and `other_loads` [N], or over reactions where only boundary conditions load the bodies;
/// zero in equilibrium at rest.
inline Real unbalanced(const Balance& sums, Real other_loads) noexcept
{
  const Real load = sums.load + other_loads;
  const Real scale = load > 0 ? load : sums.reaction;
  return scale > 0 ? sums.net / scale : 0;
}

}  // namespace talus
