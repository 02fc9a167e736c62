#pragma once
// Particles that have moved: gathered from all ranks, and what they add up to.
#include "app/observers/runout_columns.hpp"
#include "io/scene/scene_runout.hpp"
#include "solver/run_view.hpp"

namespace talus {

template <int D>
struct MovedParticle {
  std::int64_t id, eroded;
  std::array<Real, 3> start, place;  // [m]
  Real mass, volume, speed;          // [kg], [m^D], [m/s]
  Vec3 then() const { return Eigen::Map<const Vec3>(start.data()); }
  Vec3 now() const { return Eigen::Map<const Vec3>(place.data()); }
  Real side() const { return D == 2 ? std::sqrt(volume) : std::cbrt(volume); }
};

/// Those that have come `least` [m] or further, of the bodies of `spec`, in the order of their ids.  Of all ranks, on the root; every rank has to
/// ask.
template <int D>
std::vector<MovedParticle<D>> gather_moved(const RunView<D>& view, const RunoutSpec& spec, Real least);

/// All of RunoutNumbers that does not need cells.  `up` is of unit length.
template <int D>
void count_altogether(const std::vector<MovedParticle<D>>& moved, const Vec3& up, Real mass_share, RunoutNumbers& sums);

extern template std::vector<MovedParticle<2>> gather_moved<2>(const RunView<2>&, const RunoutSpec&, Real);
extern template std::vector<MovedParticle<3>> gather_moved<3>(const RunView<3>&, const RunoutSpec&, Real);
extern template void count_altogether<2>(const std::vector<MovedParticle<2>>&, const Vec3&, Real, RunoutNumbers&);
extern template void count_altogether<3>(const std::vector<MovedParticle<3>>&, const Vec3&, Real, RunoutNumbers&);

}  // namespace talus
