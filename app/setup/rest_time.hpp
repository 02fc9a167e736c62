#pragma once
// How long a stage that seeks rest usually takes to find it: for estimates before a run.
#include "app/setup/setup.hpp"

namespace talus {

/// Times from the beginning of a stage [s].  A stage that seeks no rest takes its duration, and both are that.
struct RestTime {
  Real soonest, latest;  ///< latest: at most the duration
};

/// Time that a wave takes from the foot to the top of all particles that are there at the start [s]; `up` is a unit vector.
template <int D>
Real passage_time(const Setup<D>& setup, const Vec<D>& up);

/// Local damping takes the share exp(-2 alpha) of every swing [Cundall 1987]; the slowest swing of ground on a rigid base takes four passages.  Both
/// ends are that time until the residual is left of the whole, times what was measured.
RestTime time_to_rest(const Stage& stage, Real passage);

}  // namespace talus
