#pragma once
// Sums over a step, which are rounded to numbers at its end, once for all ranks.
#include "core/parallel/communicator.hpp"
#include "solver/state/ledger.hpp"
#include "solver/state/node_work.hpp"

namespace talus {

/// Sums over the nodes at which two velocity fields, or the sides of a cut, touch.
template <int D>
struct ContactSums {
  Vec<D> impulse = Vec<D>::Zero();  ///< on the first field or side [N s]
  Vec3 angular = Vec3::Zero();      ///< its moment about the origin [N m s]
  Real
      pressure{};  ///< work of impulses along the normal on both fields [J], as force times the mean of old and new velocity: what impacts lose
  Real friction{};  ///< work of impulses across it [J], <= 0
  ContactSums& operator+=(const ContactSums& other) noexcept
  {
    impulse += other.impulse, angular += other.angular, pressure += other.pressure, friction += other.friction;
    return *this;
  }
  static constexpr auto fields()
  {
    return std::tuple{saved("impulse", &ContactSums::impulse), saved("angular", &ContactSums::angular),
                      saved("pressure", &ContactSums::pressure), saved("friction", &ContactSums::friction)};
  }
};

/// Impulses of a rigid body on material, and their work.
template <int D>
struct RigidSums {
  Vec<D> impulse = Vec<D>::Zero();  ///< [N s]
  Vec3 angular = Vec3::Zero();      ///< its moment about the origin [N m s]
  Vec3 torque = Vec3::Zero();       ///< its moment about the centre of the body [N m s]
  Real moved{};                     ///< work of the impulses with the velocity of the body [J]
  Real arrival{};   ///< what else the material gains [J]: less than zero where it meets the body, and work between node and place
  Real friction{};  ///< work of tangential impulses in the sliding of the material, <= 0 [J]
  RigidSums& operator+=(const RigidSums& other) noexcept
  {
    impulse += other.impulse, angular += other.angular, torque += other.torque;
    moved += other.moved, arrival += other.arrival, friction += other.friction;
    return *this;
  }
  static constexpr auto fields()
  {
    return std::tuple{saved("impulse", &RigidSums::impulse), saved("angular", &RigidSums::angular),
                      saved("torque", &RigidSums::torque),   saved("moved", &RigidSums::moved),
                      saved("arrival", &RigidSums::arrival), saved("friction", &RigidSums::friction)};
  }
};

template <int D>
struct StepSums {
  ExactSums<RemovedParticles<D>> removed;
  Real largest_set_back = 0;                           ///< largest distance by which a particle was moved back onto a wall [m]
  ExactSums<ForceAndMoment<D>> on_particles, on_mesh;  ///< forces of loads [N]
  ExactSums<BoundaryWork> at_nodes;                    ///< work of boundary conditions on nodes
  ExactSums<BoundaryWork>
      beyond_nodes;  ///< on nodes of small mass and linear shape functions, which the kinetic energy of the nodes does not contain
  ExactSums<NodeWork<D>> nodes;
  ExactSums<Balance> balance;
  ExactSums<Real> work_on_mesh, work_on_particles, internal;  ///< of loads, and stress power times dt [J]
  ExactSums<Real> stress_at_nodes;                  ///< work on nodes of a change of pore pressure, of the stress against jumps [J]
  ExactSums<Real> remap;                            ///< see EnergyLedger [J]
  ExactSums<Real> particles;                        ///< number of particles
  std::vector<ExactSums<ContactSums<D>>> contacts;  ///< by law of contact, then by cut
  std::vector<ExactSums<RigidSums<D>>> rigid;       ///< by rigid body
  /// Digits in use of these sums and of the impulses of boundary conditions, kept from step to step.
  Digits digits;
  void clear() noexcept
  {
    largest_set_back = 0;
    removed.clear(), on_particles.clear(), on_mesh.clear(), at_nodes.clear(), beyond_nodes.clear();
    nodes.clear(), balance.clear(), work_on_mesh.clear(), work_on_particles.clear(), internal.clear(), remap.clear();
    stress_at_nodes.clear();
    particles.clear();
    for (ExactSums<ContactSums<D>>& one : contacts)
      one.clear();
    for (ExactSums<RigidSums<D>>& one : rigid)
      one.clear();
  }
};

/// Adds the sums of a step over all ranks to the balances; gravity [m/s^2] acted over `kick` [s].  Collective.
template <int D>
void add_step(const StepSums<D>& sums, const Vec<D>& gravity, Real kick, MassLedger<D>& mass, MomentumLedger<D>& momentum,
              EnergyLedger& energy)
{
  record_removed(sums.removed.value(), mass, energy);
  const NodeWork<D> nodes = sums.nodes.value();
  const BoundaryWork boundary = sums.at_nodes.value(), beyond = sums.beyond_nodes.value();
  const ForceAndMoment<D> tractions = sums.on_particles.value() + sums.on_mesh.value();
  ContactSums<D> contact;
  for (const ExactSums<ContactSums<D>>& one : sums.contacts)
    contact += one.value();
  RigidSums<D> rigid;
  for (const ExactSums<RigidSums<D>>& one : sums.rigid)
    rigid += one.value();
  mass.on_nodes = nodes.mass;
  momentum.loads += ForceAndMoment<D>::of(kick * nodes.mass * gravity, kick * moment<D>(nodes.first_moment, gravity)) + kick * tractions;
  momentum.damping += nodes.damped;
  momentum.on_nodes += nodes.turned + beyond.turned;
  energy.gravity += nodes.gravity;
  energy.damping += nodes.damping;
  energy.walls += boundary.moved + beyond.moved + rigid.moved;
  energy.arrival += boundary.arrival + beyond.arrival + contact.pressure + rigid.arrival;
  energy.friction += boundary.friction + beyond.friction + contact.friction + rigid.friction;
  energy.waves += boundary.waves;
  energy.nodes +=
      nodes.kinetic_after - nodes.kinetic_before - boundary.arrival - contact.pressure - rigid.arrival + beyond.friction + beyond.moved;
  energy.remap += sums.remap.value();
  energy.loads += sums.work_on_mesh.value() + sums.work_on_particles.value();
  energy.internal += sums.internal.value() - sums.stress_at_nodes.value();
  energy.internal_ahead = sums.internal.value() / 2;
  energy.loads_ahead = sums.work_on_particles.value() / 2;
}

}  // namespace talus
