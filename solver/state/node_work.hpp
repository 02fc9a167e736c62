#pragma once
// Sums over the nodes of a step: energies, impulses and the balance of forces.
#include "solver/state/ledger.hpp"

namespace talus {

/// The work of boundary conditions in a step [J], and the moment of their impulses.
struct BoundaryWork {
  Real friction{};  ///< of tangential impulses of friction walls, <= 0
  Real moved{};     ///< of all other impulses with the velocity of the boundary, and of dashpots
  Real arrival{};   ///< kinetic energy lost by mass that gets the motion of the boundary: a numerical loss that depends on the mesh
  Real waves{};     ///< energy of waves incident on dashpots, whether it stays or leaves again, >= 0
  Vec3 turned = Vec3::Zero();  ///< moment of all impulses about the origin [N m s]
};

/// Sums over the nodes of a step: work [J] as force times the mean of old and new velocity, and impulses [N s].
template <int D>
struct NodeWork {
  Real kinetic_before{}, kinetic_after{}, gravity{}, damping{};
  Real mass{};                           ///< [kg]
  Vec<D> first_moment = Vec<D>::Zero();  ///< first moment of mass [kg m]
  Vec3 turned = Vec3::Zero();            ///< change of the moment of momentum about the origin [kg m^2/s]
  ForceAndMoment<D> damped;
  NodeWork& operator+=(const NodeWork& other) noexcept
  {
    kinetic_before += other.kinetic_before, kinetic_after += other.kinetic_after, gravity += other.gravity, damping += other.damping;
    mass += other.mass, first_moment += other.first_moment, turned += other.turned, damped += other.damped;
    return *this;
  }
};

/// Sums of the absolute values of forces [N].
struct Balance {
  Real net{};       ///< net force, with reactions, without damping
  Real load{};      ///< gravity
  Real reaction{};  ///< reactions of boundary conditions
  Balance& operator+=(const Balance& other) noexcept
  {
    net += other.net, load += other.load, reaction += other.reaction;
    return *this;
  }
};

}  // namespace talus
