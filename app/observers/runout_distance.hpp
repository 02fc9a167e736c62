#pragma once
// How far mass has come down and out: one definition for the run itself and for its page.
#include <optional>
#include <span>

#include "core/types.hpp"
#include "io/scene/scene_runout.hpp"

namespace talus {

/// Which particles have moved, and where the front of these is.
struct ReachRule {
  Real moved;       ///< a particle that has come less far counts as ground still [m]
  Real mass_share;  ///< of the mass that has moved, which lies no further than the front
};
/// As the scene says; a scene without `outputs.runout` is one that leaves its keys out.  `cell`: edge of the cells of the maps, by default the
/// mean size of the cells of the mesh [m].
ReachRule reach_rule(const std::optional<RunoutSpec>& spec, Real cell);

/// From the crown to the front.
struct Reach {
  Vec3 crown;           ///< the highest place at the start; of level ground the place furthest from what lies there now [m]
  Vec3 front;           ///< where the particle is that is furthest from there on the level, but for the rest of the mass [m]
  Real height, length;  ///< from one to the other, down and on the level [m]
};

/// Of particles by where they were, where they are and their mass [any unit].  `mass_share` of the mass lies no further than the front: 1 is the
/// outermost particle.  Nothing without particles.
///
/// Places that differ by no more than the rounding of single precision, in which files of particles are written, count as equal, so that a run
/// and what is read from its files have one crown and one front: of equally high places the crown is the one furthest on the level from the
/// centre of mass now, of equally far ones the front is the lowest; and of those the first.
std::optional<Reach> reach_of(std::span<const Vec3> then, std::span<const Vec3> now, std::span<const Real> mass, const Vec3& up,
                              Real mass_share);

/// The value that `mass_share` of the mass does not exceed: the largest where it is 1.  Zero without values.
Real not_exceeded_by(std::span<const Real> values, std::span<const Real> mass, Real mass_share);

/// The part of a way that is on the level.
inline Vec3 on_the_level(const Vec3& way, const Vec3& up) { return way - way.dot(up) * up; }

}  // namespace talus
