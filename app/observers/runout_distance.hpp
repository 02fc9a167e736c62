#pragma once
// Vertical and horizontal run-out distance: one definition for the run and for its report.
#include <optional>
#include <span>

#include "app/observers/runout_files.hpp"
#include "core/types.hpp"
#include "io/scene/scene_runout.hpp"
#include "solver/run_view.hpp"

namespace talus {

/// The rule for moved particles and their front.
struct ReachRule {
  Real moved;       ///< smallest displacement of a moved particle [m]
  Real mass_share;  ///< fraction of the moved mass that does not lie beyond the front
};
/// The rule of the scene, with defaults without `outputs.runout`.  `cell`: edge of the cells of the maps, by default the mean size of the
/// cells of the mesh [m].
ReachRule reach_rule(const std::optional<RunoutSpec>& spec, Real cell);

/// The distance from the crown to the front.
struct Reach {
  Vec3 crown;           ///< the highest initial position; for level ground the position furthest from the present centre [m]
  Vec3 front;           ///< the position of the particle furthest from the crown horizontally, without the remaining mass fraction [m]
  Real height, length;  ///< vertical and horizontal distance between them [m]
};

/// The reach of particles from initial positions, present positions and masses [any unit].  `mass_share` of the mass does not lie beyond
/// the front: 1 is the outermost particle.  Nothing without particles.  Positions that differ by no more than the rounding of single
/// precision, which files of particles use, count as equal, so that a run and its files give the same crown and front: of equally high
/// positions the crown is the one furthest horizontally from the present centre of mass, of equally far ones the front is the lowest; and
/// of those the first.
std::optional<Reach> reach_of(std::span<const Vec3> then, std::span<const Vec3> now, std::span<const Real> mass, const Vec3& up,
                              Real mass_share);

/// The value that `mass_share` of the mass does not exceed: the largest one if it is 1.  Zero without values.
Real not_exceeded_by(std::span<const Real> values, std::span<const Real> mass, Real mass_share);

/// The horizontal part of a vector.
inline Vec3 on_the_level(const Vec3& way, const Vec3& up) { return way - way.dot(up) * up; }

template <int D>
struct MovedParticle {
  std::int64_t id, eroded;
  std::array<Real, 3> start, place;  // initial and present position [m]
  Real mass, volume, speed;          // [kg], [m^D], [m/s]
  Vec3 then() const { return Eigen::Map<const Vec3>(start.data()); }
  Vec3 now() const { return Eigen::Map<const Vec3>(place.data()); }
  Real side() const { return D == 2 ? std::sqrt(volume) : std::cbrt(volume); }
};

/// The particles of the bodies of `spec` with a displacement of at least `least` [m], in the order of their ids.  Over all ranks, on the
/// root.  Collective.
template <int D>
std::vector<MovedParticle<D>> gather_moved(const RunView<D>& view, const RunoutSpec& spec, Real least);

/// The part of RunoutNumbers that does not need cells.  `up` is a unit vector.
template <int D>
void count_altogether(const std::vector<MovedParticle<D>>& moved, const Vec3& up, Real mass_share, RunoutNumbers& sums);

}  // namespace talus
