#pragma once
// Estimates before a run: its duration from a few of its steps, and how long a stage that seeks rest usually takes to find it.
#include "app/run/simulate.hpp"
#include "app/setup/setup.hpp"

namespace talus {

/// A few steps of a stage, from the state at the start of the run.
struct StageTrial {
  std::string name;
  std::size_t stage;              ///< number of the stage
  Real dt;                        ///< mean length of the steps [s]
  Real quickest, usual, slowest;  ///< median and quartiles of their wall times [s]
  std::int64_t made;              ///< number of steps
};

/// Computes the first steps of each stage, in memory, stage after stage, without output.  A stage ends where a step fails: the steps before
/// count, and RunError is thrown if there are none.
template <int D>
std::vector<StageTrial> try_stages(const Scene& scene, Mesh<D> mesh, Setup<D> setup);

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
