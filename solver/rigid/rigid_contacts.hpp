#pragma once
// Contacts of rigid bodies with each other and with walls.
#include <span>
#include <vector>

#include "solver/rigid/rigid_body.hpp"

namespace talus {

/// A point at which two rigid bodies, or one and a wall, touch or are about to.
template <int D>
struct RigidContact {
  Index first = none, second = none;  ///< bodies; no second one: a wall
  Index wall = none;                  ///< its number
  Vec<D> place = Vec<D>::Zero();
  Vec<D> normal = Vec<D>::Zero();  ///< unit length, towards the first
  Real gap{};                      ///< [m]; negative where they overlap
  Real friction{};
  Real pressed{};                  ///< impulse along the normal on the first [N s]
  Vec<D> rubbed = Vec<D>::Zero();  ///< impulse across it
};

/// The points at which bodies touch or may touch within a step: the nearest point of a ball, and of facets the sampled points of each surface
/// that lie nearest to the other, at most two in 2-D and six in 3-D for a pair.  Edges that cross in 3-D are seen at the samples along them.
/// A ball touches a sheet at the point of its faces nearest to the centre too; other solids only where samples of the sheet are in them.
/// Nothing is behind a wall beside its rim, save the points just past it, so that walls which meet at an edge leave no gap there.
template <int D>
std::vector<RigidContact<D>> find_contacts(const RigidScene<D>& scene, std::span<const RigidState<D>> states, Real dt);

/// Changes the velocities of free bodies such that none comes nearer to another than its gap in a step of dt [s]; Coulomb friction, no rebound.
/// Impulses of all contacts are found in turns (projected Gauss-Seidel, as in Catto, Iterative dynamics with temporal coherence, 2005).
/// Bodies that overlap are moved apart by a fifth of that in a step, without velocity: of the mean over the points at which they do.
template <int D>
void act_on_contacts(const RigidScene<D>& scene, Real dt, std::span<RigidContact<D>> contacts, std::span<RigidState<D>> states);

}  // namespace talus
