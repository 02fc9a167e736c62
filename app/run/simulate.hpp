#pragma once
// Turns the name of the kernel into a type, once: builds the model and runs its stages.
#include <functional>

#include "app/run/disk_space.hpp"
#include "app/setup/checks/shared_nodes.hpp"
#include "app/setup/setup.hpp"
#include "solver/run_view.hpp"

namespace talus {

/// The callbacks of a run.
template <int D>
struct RunCallbacks {
  std::function<void(const RunView<D>&, RunEvent)> watch;
  std::function<void(const RunView<D>&, const StageResult&)> stage_done;
  /// If set: replaces the initial state by that of an earlier run.
  std::function<void(State<D>&)> take_over = {};
  /// Called with the changes by a stage, before it begins.
  std::function<void(const RunView<D>&, const Stage&, const StageReport&)> changed = [](const RunView<D>&, const Stage&,
                                                                                        const StageReport&) {};
  /// Called when everything that the run needs exists, before the first step.
  std::function<void(const RunView<D>&)> ready = [](const RunView<D>&) {};
  /// Called before the particles are copied for an observer, which takes as much memory as the copy of a checkpoint.
  std::function<void()> before_copy = [] {};
  /// Called with the wall time [s] in which the kernel was set up, before `ready`.
  std::function<void(Real seconds)> kernel_made = [](Real) {};
};

/// A redistribution of the work among ranks.
struct Rebalanced {
  Clock clock;             ///< time of the redistribution
  Real before{}, after{};  ///< imbalance: work of the busiest rank over the mean
  Real seconds{};          ///< duration [s]
};

/// How the work is redistributed among ranks during a run; results do not depend on it.
template <int D>
struct LoadBalancing {
  std::optional<std::int64_t> every = 0;                    ///< number of steps between redistributions; 0: never; nothing: when it pays
  std::function<Mesh<D>()> whole_mesh = {};                 ///< returns the same mesh as at the start; if it throws, the distribution stays
  Real mesh_seconds = 0;                                    ///< approximate time that this takes [s]
  std::function<void(const Rebalanced&)> moved = {};        ///< called after each redistribution
  std::function<void(const std::string& why)> stayed = {};  ///< called if redistribution is impossible, and will not be tried again
};

/// The cost of a model before its first step.
struct Estimate {
  Real dt;  ///< length of the first step [s]
  std::int64_t particle_bytes, mesh_bytes, node_bytes;
  std::int64_t nodes_as_corners;          ///< of the kernel, see RunView
  std::vector<SharedNodes> shared_nodes;  ///< of the bodies that are present at the start
  FileSizes files;                        ///< on the disk
};

template <int D>
Real total_duration(const Setup<D>& setup)
{
  Real total = 0;
  for (const Stage& stage : setup.stages)
    total += stage.duration;
  return total;
}

/// The length of the first step [s] that the particles of this rank allow, independent of the kernel.
template <int D>
Real first_step(const Mesh<D>& mesh, const Setup<D>& setup);

/// Runs all stages, or the remaining ones.  Throws SceneErrors if the kernel refuses the mesh, RunError if a stage failed; the callbacks
/// have received the state before.
template <int D>
void simulate(const Scene& scene, Mesh<D> mesh, Setup<D> setup, const RunCallbacks<D>& callbacks, const LoadBalancing<D>& moves = {});

/// Builds the model and destroys it.
template <int D>
Estimate estimate(const Scene& scene, Mesh<D> mesh, Setup<D> setup);

}  // namespace talus
