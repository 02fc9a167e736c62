#pragma once
// Sums over the nodes of a step: energies, impulses and the balance of forces.
#include "solver/state/ledger.hpp"

namespace talus {

/// What walls did to the energy of the bodies in a step [J], and to their moment of momentum.
struct BoundaryWork {
  Real friction{};  ///< of tangential impulses of friction walls, <= 0
  Real moved{};     ///< of all other impulses with the velocity that the wall has itself, and of dashpots
  Real arrival{};   ///< what these take beyond it, from mass that does not move as the wall does: numerical, as the mesh makes it so
  Real waves{};     ///< energy that waves brought to dashpots, whether it stays or leaves again, >= 0
  Vec3 turned = Vec3::Zero();  ///< moment of all impulses about the origin [N m s]
};

/// What a step did to the nodes: work [J], force times the mean of old and new velocity, and impulses [N s].
template <int D>
struct NodeWork {
  Real kinetic_before{}, kinetic_after{}, gravity{}, damping{};
  Real mass{};                           ///< [kg]
  Vec<D> first_moment = Vec<D>::Zero();  ///< of mass [kg m]
  Vec3 turned = Vec3::Zero();            ///< change of the moment of momentum about the origin [kg m^2/s]
  ForceAndMoment<D> damped;
  NodeWork& operator+=(const NodeWork& other) noexcept
  {
    kinetic_before += other.kinetic_before, kinetic_after += other.kinetic_after, gravity += other.gravity, damping += other.damping;
    mass += other.mass, first_moment += other.first_moment, turned += other.turned, damped += other.damped;
    return *this;
  }
};

/// Sums of the moduli of forces [N].
struct Balance {
  Real net{};       ///< with wall reactions, without damping
  Real load{};      ///< gravity
  Real reaction{};  ///< of walls
  Balance& operator+=(const Balance& other) noexcept
  {
    net += other.net, load += other.load, reaction += other.reaction;
    return *this;
  }
};

}  // namespace talus
