#pragma once
// The kernel's name becomes a type here, once: builds the model and runs its stages.
#include <functional>

#include "app/run/disk_space.hpp"
#include "app/setup/checks/shared_nodes.hpp"
#include "app/setup/setup.hpp"
#include "solver/run_view.hpp"

namespace talus {

/// Who watches a run.
template <int D>
struct RunCallbacks {
  std::function<void(const RunView<D>&, RunEvent)> watch;
  std::function<void(const RunView<D>&, const StageResult&)> stage_done;
  /// If set: puts the state of an earlier run in the place of that at the start.
  std::function<void(State<D>&)> take_over = {};
  /// Told what a stage has changed, before it begins.
  std::function<void(const RunView<D>&, const Stage&, const StageReport&)> changed = [](const RunView<D>&, const Stage&,
                                                                                        const StageReport&) {};
  /// Told when all is there that the run needs, before anything is done.
  std::function<void(const RunView<D>&)> ready = [](const RunView<D>&) {};
};

/// Ranks have shared the run out anew.
struct Rebalanced {
  Clock clock;             ///< at the time
  Real before{}, after{};  ///< work of the busiest rank over the mean
  Real seconds{};          ///< that it took
};

/// How several ranks go on sharing a run, whose results do not depend on it.
template <int D>
struct LoadBalancing {
  std::optional<std::int64_t> every = 0;                    ///< shares move after so many steps; 0: never; nothing: when it pays
  std::function<Mesh<D>()> whole_mesh = {};                 ///< the same as at the start; what it throws leaves the shares as they are
  Real mesh_seconds = 0;                                    ///< that this takes, about
  std::function<void(const Rebalanced&)> moved = {};        ///< told of each time
  std::function<void(const std::string& why)> stayed = {};  ///< told that they cannot move, and will not any more
};

/// What a model costs before it has made a step.
struct Estimate {
  Real dt;  ///< first step [s]
  std::int64_t particle_bytes, mesh_bytes, node_bytes;
  std::int64_t nodes_as_corners;          ///< by the kernel, see Frame
  std::vector<SharedNodes> shared_nodes;  ///< of the bodies that are there at the start
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

/// First step that the particles of this rank allow [s]; no kernel is asked.
template <int D>
Real first_step(const Mesh<D>& mesh, const Setup<D>& setup);

/// Runs all stages, or those that are left.  SceneErrors: the kernel refuses the mesh.  RunError: a stage failed; the state before is what the audience saw.
template <int D>
void simulate(const Scene& scene, Mesh<D> mesh, Setup<D> setup, const RunCallbacks<D>& audience, const LoadBalancing<D>& moves = {});

/// Builds the model and lets it go.
template <int D>
Estimate estimate(const Scene& scene, Mesh<D> mesh, Setup<D> setup);

extern template Real first_step<2>(const Mesh<2>&, const Setup<2>&);
extern template Real first_step<3>(const Mesh<3>&, const Setup<3>&);
extern template void simulate<2>(const Scene&, Mesh<2>, Setup<2>, const RunCallbacks<2>&, const LoadBalancing<2>&);
extern template void simulate<3>(const Scene&, Mesh<3>, Setup<3>, const RunCallbacks<3>&, const LoadBalancing<3>&);
extern template Estimate estimate<2>(const Scene&, Mesh<2>, Setup<2>);
extern template Estimate estimate<3>(const Scene&, Mesh<3>, Setup<3>);

}  // namespace talus
