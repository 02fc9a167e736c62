#pragma once
// Where energy, momentum and mass went: every term is computed by itself, so that the balance proves something.
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/fields.hpp"
#include "core/parallel/exact_sum.hpp"
#include "core/particles.hpp"

namespace talus {

/// Sums over a stage since it began [J], except where noted.
struct EnergyLedger {
  Real gravity{};   ///< work of gravity
  Real loads{};     ///< work of tractions and pressures
  Real walls{};     ///< work of walls other than friction: of those that move, and of dashpots
  Real friction{};  ///< work of friction, <= 0
  Real waves{};     ///< energy that waves brought to walls that give way: part of the work of walls, and a measure of it
  Real damping{};   ///< work of local damping, <= 0
  Real arrival{};   ///< kinetic energy that mass loses where walls make it move as they do, <= 0: part of what transfer() gives
  Real
      nodes{};  ///< change of the nodes' kinetic energy within the steps but for arrival, and what walls did to nodes of small mass and linear shape functions
  Real remap{};     ///< MUSL: what internal forces and loads did in the part of the new velocities that the remap takes out again
  Real internal{};  ///< stress power of the particles: strain energy plus what the laws dissipate
  Real kinetic_start{}, plastic_start{};  ///< at the beginning of the stage
  Real set_to_rest{};                     ///< kinetic energy that a stage which ends at rest takes out at its end
  Real carried_away{};                    ///< kinetic energy of the particles that were deleted
  Real plastic_deleted{};                 ///< plastic work that they had behind them
  Real largest_before{};                  ///< largest term of the stages before
  Real largest_seen{};                    ///< largest term at any time up to now, and not less than what is judged: the size of the balance
  Real internal_ahead{}, loads_ahead{};   ///< of `internal`, and of `loads` on particles: done after the time of the velocities
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
                      saved("plastic_deleted", &EnergyLedger::plastic_deleted),
                      saved("largest_before", &EnergyLedger::largest_before),
                      saved("largest_seen", &EnergyLedger::largest_seen),
                      saved("internal_ahead", &EnergyLedger::internal_ahead),
                      saved("loads_ahead", &EnergyLedger::loads_ahead)};
  }

  /// With what was done up to the time of the velocities, by which kinetic energies and all other works are counted: that of stress and
  /// places is half a step later.
  EnergyLedger at_velocities() const noexcept
  {
    EnergyLedger then = *this;
    then.internal -= std::exchange(then.internal_ahead, 0);
    then.loads -= std::exchange(then.loads_ahead, 0);
    return then;
  }

  /// Largest of the terms, of this stage and of those before: what errors are measured by [J].
  Real largest_term(Real kinetic_now) const noexcept
  {
    Real largest = largest_before;
    for (const Real term : {kinetic_start, kinetic_now, internal, gravity, loads, walls, friction, waves, damping, carried_away})
      largest = std::max(largest, std::abs(term));
    return largest;
  }

  /// Kinetic energy lost between particles and nodes: what the nodes gained and the particles, deleted ones included, did not get.  What
  /// the remap takes out again nodes have gained in vain: strain, which is taken from remapped velocities, has not given it.
  Real transfer(Real kinetic_now) const noexcept { return nodes - remap - (kinetic_now - kinetic_start + carried_away); }
  /// All work done on the bodies, minus what became of it: zero if everything is accounted for, at_velocities().
  Real defect(Real kinetic_now) const noexcept
  {
    return gravity + loads + walls + friction + damping - internal - transfer(kinetic_now) - carried_away - (kinetic_now - kinetic_start);
  }
};

/// x cross f, in 2-D with the plane's only component last.
template <int D>
Vec3 moment(const Vec<D>& x, const Vec<D>& f) noexcept
{
  if constexpr (D == 2)
    return {0, 0, x[0] * f[1] - x[1] * f[0]};
  else
    return {x[1] * f[2] - x[2] * f[1], x[2] * f[0] - x[0] * f[2], x[0] * f[1] - x[1] * f[0]};
}

/// Forces [N] or impulses [N s], their moment about the origin, and the sums of the moduli of both.
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

/// What gave momentum to the bodies since the start of the run, but for walls, which keep their own [N s].
template <int D>
struct MomentumLedger {
  ForceAndMoment<D> loads;  ///< gravity, tractions, forces of place
  ForceAndMoment<D> damping;
  ForceAndMoment<D> rest;        ///< of the motion that is taken out at the end of stages that seek rest
  ForceAndMoment<D> changes;     ///< of what stages place and take away: bodies, and mass where a density changes
  Vec3 on_nodes = Vec3::Zero();  ///< moment of momentum that nodes, and what hangs on them, got within the steps [kg m^2/s]
  static constexpr auto fields()
  {
    return std::tuple{saved("loads", &MomentumLedger::loads), saved("damping", &MomentumLedger::damping),
                      saved("rest", &MomentumLedger::rest), saved("changes", &MomentumLedger::changes),
                      saved("on_nodes", &MomentumLedger::on_nodes)};
  }
};

template <int D>
struct MassLedger {
  Real start{};     ///< [kg]
  Real on_nodes{};  ///< what the nodes carried in the last step, less what failed in it [kg]
  Real deleted{};   ///< left the mesh, or failed [kg]
  Real failed{};    ///< of it what failed [kg]
  Index deleted_count{}, failed_count{};
  Real placed{}, taken{};  ///< by stages: bodies that appeared and vanished, and what a new density made heavier and lighter [kg]
  Index placed_count{}, taken_count{};
  ForceAndMoment<D> carried_away;  ///< momentum of what was deleted
  std::int64_t held_count{};       ///< times a particle was set back onto a closed wall
  Real largest_set_back{};         ///< farthest such set-back [m]
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
  /// That should be there [kg].
  Real due() const noexcept { return start + placed - deleted - taken; }
};

/// What particles take along that are deleted, and what was done to those that stay; numbers of particles are whole.
template <int D>
struct RemovedParticles {
  Real mass{}, count{}, failed{}, failed_count{};  ///< [kg], of them those that failed
  Real kinetic{}, plastic{};                       ///< [J]
  ForceAndMoment<D> momentum{};
  Real held_count{};  ///< set back onto a closed wall
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
  Vec3 angular = Vec3::Zero();       ///< about the origin, with the affine part of the particle's own field left out [kg m^2/s]
  Vec<D> centre = Vec<D>::Zero();    ///< first moment of mass [kg m]
  Totals& operator+=(const Totals& other) noexcept
  {
    mass += other.mass, kinetic += other.kinetic, momentum += other.momentum, angular += other.angular, centre += other.centre;
    return *this;
  }
};

/// Those of one particle.
template <int D>
Totals<D> totals_of(const Particles<D>& particles, std::size_t p) noexcept
{
  const Real m = particles.mass[p];
  const Vec<D> x = particles.x[p], v = particles.v[p];
  return {m, 0.5 * m * v.squaredNorm(), m * v, m * moment<D>(x, v), m * x};
}

}  // namespace talus
