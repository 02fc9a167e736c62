#pragma once
// Estimate of the duration of a run from a few of its steps.
#include "app/run/simulate.hpp"

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

}  // namespace talus
