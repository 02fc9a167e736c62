#pragma once
// The levels of a convergence study: a scene, and the same with larger or smaller cells.
#include "app/commands/converge/converge_command.hpp"
#include "app/commands/queue/planned_run.hpp"
#include "io/scene/scene.hpp"

namespace talus {

struct ConvergeLevel : PlannedRun {
  Real factor = 1;                   ///< of the sizes in the scene [-]
  std::vector<std::string> of_mesh;  ///< the changes of the mesh, as for --set
  Index cells = 0;
  std::int64_t particles = 0;
  Real size = 0;  ///< mean size of the cells, (volume / number)^(1/D) [m]
};

struct ConvergePlan {
  std::filesystem::path scene, folder;
  bool quick = false;
  Scene spec;                         ///< including the changes by the user
  std::vector<ConvergeLevel> levels;  ///< from coarse to fine
  std::vector<std::string> warnings;  ///< of meshes that are not similar to each other
};

/// The changes that multiply all sizes of generated cells by a factor.  `mesh`: as in the file, before `accuracy` scales it.  Sizes are
/// rounded to six digits; numbers of intervals to whole ones.
std::vector<std::string> scaled_mesh(const MeshSpec& mesh, Real factor);

/// Reads the scene of each level, makes its mesh, and builds the model of each level that would start anew.  Throws SceneErrors with all
/// errors of the scene, of its levels, and with reasons why its cells cannot be made smaller.
ConvergePlan plan_convergence(const ConvergeOptions& options);

}  // namespace talus
