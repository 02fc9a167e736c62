#pragma once
// How far mass has come down and out: one definition for the run itself and for its page.
#include <optional>
#include <span>

#include "core/types.hpp"

namespace talus {

/// From the crown to the front.
struct Reach {
  Vec3 crown;           ///< the highest place at the start [m]
  Vec3 front;           ///< where the particle is that is furthest from there on the level, but for the rest of the mass [m]
  Real height, length;  ///< from one to the other, down and on the level [m]
};

/// Of particles by where they were, where they are and their mass [any unit]; of equal ones the first counts.  `mass_share` of the mass lies no
/// further than the front: 1 is the outermost particle.  Nothing without particles.
std::optional<Reach> reach_of(std::span<const Vec3> then, std::span<const Vec3> now, std::span<const Real> mass, const Vec3& up,
                              Real mass_share);

/// The part of a way that is on the level.
inline Vec3 on_the_level(const Vec3& way, const Vec3& up) { return way - way.dot(up) * up; }

}  // namespace talus
