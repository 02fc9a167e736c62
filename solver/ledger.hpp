#pragma once
// Where energy, momentum and mass went: every term is computed by itself, so that the balance proves something.
#include "core/fields.hpp"
#include "core/particles.hpp"

namespace talus {

/// Sums over a stage since it began [J], except where noted.
struct EnergyLedger {
  Real gravity{};                         ///< work of gravity
  Real loads{};                           ///< work of tractions and pressures
  Real walls{};                           ///< work of walls other than friction: prescribed motion, inelastic arrival
  Real friction{};                        ///< work of friction, <= 0
  Real damping{};                         ///< work of local damping, <= 0
  Real nodes{};                           ///< change of the nodes' kinetic energy within the steps, and what walls did to slaves and hats
  Real internal{};                        ///< stress power of the particles: strain energy plus what the laws dissipate
  Real kinetic_start{}, plastic_start{};  ///< at the beginning of the stage
  Real set_to_rest{};                     ///< kinetic energy that a stage which ends at rest takes out at its end
  static constexpr auto fields()
  {
    return std::tuple{kept("gravity", &EnergyLedger::gravity),
                      kept("loads", &EnergyLedger::loads),
                      kept("walls", &EnergyLedger::walls),
                      kept("friction", &EnergyLedger::friction),
                      kept("damping", &EnergyLedger::damping),
                      kept("nodes", &EnergyLedger::nodes),
                      kept("internal", &EnergyLedger::internal),
                      kept("kinetic_start", &EnergyLedger::kinetic_start),
                      kept("plastic_start", &EnergyLedger::plastic_start),
                      kept("set_to_rest", &EnergyLedger::set_to_rest)};
  }

  /// Kinetic energy lost between particles and nodes: what the nodes gained and the particles did not get.
  Real transfer(Real kinetic_now) const noexcept { return nodes - (kinetic_now - kinetic_start); }
  /// All work done on the bodies, minus what became of it: zero if everything is accounted for.
  Real defect(Real kinetic_now) const noexcept
  {
    return gravity + loads + walls + friction + damping - internal - transfer(kinetic_now) - (kinetic_now - kinetic_start);
  }
};

struct MassLedger {
  Real start{};    ///< [kg]
  Real deleted{};  ///< left the mesh [kg]
  Index deleted_count{};
  std::int64_t held_count{};  ///< times a particle was set back onto a closed wall
  Real held_most{};           ///< farthest such set-back [m]
  static constexpr auto fields()
  {
    return std::tuple{kept("start", &MassLedger::start), kept("deleted", &MassLedger::deleted),
                      kept("deleted_count", &MassLedger::deleted_count), kept("held_count", &MassLedger::held_count),
                      kept("held_most", &MassLedger::held_most)};
  }
};

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

template <int D>
Totals<D> totals(const Particles<D>& particles);

extern template Totals<2> totals<2>(const Particles<2>&);
extern template Totals<3> totals<3>(const Particles<3>&);

}  // namespace talus
