#pragma once
// Balances of energy, momentum and mass.  Every term is computed independently, so a closed balance is evidence.
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/fields.hpp"
#include "core/parallel/exact_sum.hpp"
#include "core/particles.hpp"

namespace talus {

/// Sums over a stage since its beginning [J], except where noted.
struct EnergyLedger {
  Real gravity{};   ///< work of gravity
  Real loads{};     ///< work of tractions and pressures
  Real walls{};     ///< work of boundary conditions other than friction: of prescribed motions and dashpots
  Real friction{};  ///< work of friction at walls and between bodies, <= 0
  Real waves{};     ///< energy of waves incident on absorbing boundaries; a part of the work of walls, given for reference
  Real damping{};   ///< work of local damping, <= 0
  /// Kinetic energy lost where a boundary gives mass its motion, and where nodes of two bodies meet, <= 0; part of the result of transfer().
  Real arrival{};
  /// Change of the nodes' kinetic energy within the steps without arrival, and work of boundaries on nodes of small mass and linear shape
  /// functions.
  Real nodes{};
  Real remap{};     ///< MUSL: work of internal forces and loads in the part of the new velocities that the remap removes
  Real internal{};  ///< stress power of the particles: strain energy plus dissipation of the laws
  Real kinetic_start{}, plastic_start{};  ///< values at the beginning of the stage
  Real set_to_rest{};                     ///< kinetic energy removed at the end of a stage that ends in equilibrium
  Real carried_away{};                    ///< kinetic energy of deleted particles
  Real resampled{};                       ///< kinetic energy lost where particles are merged, less what it gains where they are split
  Real plastic_deleted{};                 ///< plastic work of deleted particles
  Real largest_before{};                  ///< largest term of the stages before
  /// Largest term at any time so far, at least the least energy that is judged: the size of the balance.
  Real largest_seen{};
  Real internal_ahead{}, loads_ahead{};  ///< parts of `internal`, and of `loads` on particles, done after the time of the velocities
  static constexpr auto fields()
  {
    return std::tuple{saved("gravity", &EnergyLedger::gravity),
                      saved("loads", &EnergyLedger::loads),
                      saved("walls", &EnergyLedger::walls),
                      saved("friction", &EnergyLedger::friction),
                      saved("waves", &EnergyLedger::waves),
                      saved("damping", &EnergyLedger::damping),
                      saved("arrival", &EnergyLedger::arrival),
                      saved("nodes", &EnergyLedger::nodes),
                      saved("remap", &EnergyLedger::remap),
                      saved("internal", &EnergyLedger::internal),
                      saved("kinetic_start", &EnergyLedger::kinetic_start),
                      saved("plastic_start", &EnergyLedger::plastic_start),
                      saved("set_to_rest", &EnergyLedger::set_to_rest),
                      saved("carried_away", &EnergyLedger::carried_away),
                      saved("resampled", &EnergyLedger::resampled),
                      saved("plastic_deleted", &EnergyLedger::plastic_deleted),
                      saved("largest_before", &EnergyLedger::largest_before),
                      saved("largest_seen", &EnergyLedger::largest_seen),
                      saved("internal_ahead", &EnergyLedger::internal_ahead),
                      saved("loads_ahead", &EnergyLedger::loads_ahead)};
  }

  /// The balance with the work done up to the time of the velocities, which kinetic energies and all other works refer to; stress and
  /// positions are half a step later.
  EnergyLedger at_velocities() const noexcept
  {
    EnergyLedger then = *this;
    then.internal -= std::exchange(then.internal_ahead, 0);
    then.loads -= std::exchange(then.loads_ahead, 0);
    return then;
  }

  /// The largest of the terms [J], of this stage and those before; errors are relative to it.
  Real largest_term(Real kinetic_now) const noexcept
  {
    Real largest = largest_before;
    for (const Real term : {kinetic_start, kinetic_now, internal, gravity, loads, walls, friction, waves, damping, carried_away, resampled})
      largest = std::max(largest, std::abs(term));
    return largest;
  }

  /// Kinetic energy that particles have lost between steps [J].
  Real gone() const noexcept { return carried_away + resampled; }
  /// The kinetic energy lost between particles and nodes: the gain of the nodes minus that of the particles, deleted ones included.  The
  /// part that the remap removes is subtracted, because strain, which is computed from remapped velocities, does not provide it.
  Real transfer(Real kinetic_now) const noexcept { return nodes - remap - (kinetic_now - kinetic_start + gone()); }
  /// All work done on the bodies minus the energy terms [J]: zero if the balance is closed, for at_velocities().
  Real defect(Real kinetic_now) const noexcept
  {
    return gravity + loads + walls + friction + damping - internal - transfer(kinetic_now) - gone() - (kinetic_now - kinetic_start);
  }
};

/// The cross product x cross f; in 2-D the only component is the last one.
template <int D>
Vec3 moment(const Vec<D>& x, const Vec<D>& f) noexcept
{
  if constexpr (D == 2)
    return {0, 0, x[0] * f[1] - x[1] * f[0]};
  else
    return {x[1] * f[2] - x[2] * f[1], x[2] * f[0] - x[0] * f[2], x[0] * f[1] - x[1] * f[0]};
}

/// Forces [N] or impulses [N s], their moment about the origin, and the sums of the absolute values of both.
template <int D>
struct ForceAndMoment {
  Vec<D> linear = Vec<D>::Zero();
  Vec3 angular = Vec3::Zero();
  Real size{}, turn{};
  static constexpr auto fields()
  {
    return std::tuple{saved("linear", &ForceAndMoment::linear), saved("angular", &ForceAndMoment::angular),
                      saved("size", &ForceAndMoment::size), saved("turn", &ForceAndMoment::turn)};
  }

  static ForceAndMoment of(const Vec<D>& f, const Vec3& about) noexcept { return {f, about, f.norm(), about.norm()}; }
  static ForceAndMoment at(const Vec<D>& x, const Vec<D>& f) noexcept { return of(f, moment<D>(x, f)); }
  ForceAndMoment& operator+=(const ForceAndMoment& other) noexcept
  {
    linear += other.linear, angular += other.angular, size += other.size, turn += other.turn;
    return *this;
  }
  friend ForceAndMoment operator+(ForceAndMoment a, const ForceAndMoment& b) noexcept { return a += b; }
  friend ForceAndMoment operator*(Real s, const ForceAndMoment& a) noexcept
  {
    return {s * a.linear, s * a.angular, std::abs(s) * a.size, std::abs(s) * a.turn};
  }
};

/// The impulses on the bodies since the start of the run [N s], without those of boundary conditions, which store their own.
template <int D>
struct MomentumLedger {
  ForceAndMoment<D> loads;  ///< gravity, tractions, body forces
  ForceAndMoment<D> damping;
  ForceAndMoment<D> rest;        ///< of the motion that is removed at the end of stages that seek equilibrium
  ForceAndMoment<D> changes;     ///< of placed and removed bodies, of mass where a density changes, of particles split and merged
  Vec3 on_nodes = Vec3::Zero();  ///< change of angular momentum of nodes and nodes of small mass within the steps [kg m^2/s]
  static constexpr auto fields()
  {
    return std::tuple{saved("loads", &MomentumLedger::loads), saved("damping", &MomentumLedger::damping),
                      saved("rest", &MomentumLedger::rest), saved("changes", &MomentumLedger::changes),
                      saved("on_nodes", &MomentumLedger::on_nodes)};
  }
};

template <int D>
struct MassLedger {
  Real start{};     ///< mass at the start [kg]
  Real on_nodes{};  ///< mass at the nodes in the last step without particles that failed in it [kg]
  Real deleted{};   ///< mass of particles that left the mesh or failed [kg]
  Real failed{};    ///< part of `deleted` that failed [kg]
  Index deleted_count{}, failed_count{};
  Real placed{}, taken{};  ///< mass added and removed by stages: bodies, and changes of density [kg]
  Index placed_count{}, taken_count{};
  ForceAndMoment<D> carried_away;  ///< momentum of deleted particles
  std::int64_t held_count{};       ///< number of times a particle was moved back onto a closed wall
  Real largest_set_back{};         ///< largest such distance [m]
  static constexpr auto fields()
  {
    return std::tuple{saved("start", &MassLedger::start),
                      saved("on_nodes", &MassLedger::on_nodes),
                      saved("deleted", &MassLedger::deleted),
                      saved("failed", &MassLedger::failed),
                      saved("deleted_count", &MassLedger::deleted_count),
                      saved("failed_count", &MassLedger::failed_count),
                      saved("placed", &MassLedger::placed),
                      saved("taken", &MassLedger::taken),
                      saved("placed_count", &MassLedger::placed_count),
                      saved("taken_count", &MassLedger::taken_count),
                      saved("carried_away", &MassLedger::carried_away),
                      saved("held_count", &MassLedger::held_count),
                      saved("held_most", &MassLedger::largest_set_back)};
  }
  /// The mass that should be present [kg].
  Real due() const noexcept { return start + placed - deleted - taken; }
};

/// Sums over deleted particles and over particles moved back onto a wall; counts are whole numbers.
template <int D>
struct RemovedParticles {
  Real mass{}, count{}, failed{}, failed_count{};  ///< mass and number of deleted particles, and of those that failed [kg, -]
  Real kinetic{}, plastic{};                       ///< kinetic energy and plastic work of deleted particles [J]
  ForceAndMoment<D> momentum{};
  Real held_count{};  ///< number of particles moved back onto a closed wall
};
template <int D>
void record_removed(const RemovedParticles<D>& gone, MassLedger<D>& mass, EnergyLedger& energy) noexcept
{
  mass.deleted += gone.mass, mass.failed += gone.failed;
  mass.on_nodes -= gone.failed;  // it took part in the step in which it failed
  mass.deleted_count += static_cast<Index>(gone.count), mass.failed_count += static_cast<Index>(gone.failed_count);
  mass.held_count += static_cast<std::int64_t>(gone.held_count);
  mass.carried_away += gone.momentum;
  energy.carried_away += gone.kinetic, energy.plastic_deleted += gone.plastic;
}

/// Totals over the particles at one time.
template <int D>
struct Totals {
  Real mass{}, kinetic{};            ///< [kg], [J]
  Vec<D> momentum = Vec<D>::Zero();  ///< [kg m/s]
  Vec3 angular = Vec3::Zero();       ///< about the origin, without the affine part of the particle's own field [kg m^2/s]
  Vec<D> centre = Vec<D>::Zero();    ///< first moment of mass [kg m]
  Totals& operator+=(const Totals& other) noexcept
  {
    mass += other.mass, kinetic += other.kinetic, momentum += other.momentum, angular += other.angular, centre += other.centre;
    return *this;
  }
};

/// The contribution of one particle; not inlined, so that it is bitwise identical everywhere.
template <int D>
[[gnu::noinline]] Totals<D> totals_of(Real m, const Vec<D>& x, const Vec<D>& v) noexcept
{
  return {m, 0.5 * m * v.squaredNorm(), m * v, m * moment<D>(x, v), m * x};
}
template <int D>
Totals<D> totals_of(const Particles<D>& particles, std::size_t p) noexcept
{
  return totals_of<D>(particles.mass[p], particles.x[p], particles.v[p]);
}

}  // namespace talus
