#pragma once
// Particles that have moved, collected from all ranks, and sums over them.
#include "app/observers/runout_columns.hpp"
#include "io/scene/scene_runout.hpp"
#include "solver/run_view.hpp"

namespace talus {

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
