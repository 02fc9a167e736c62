#pragma once
// The runs behind a factor of safety: one that comes to rest, and trials that begin there with their strength divided.
#include "app/commands/fos/fos_command.hpp"
#include "app/commands/sweep/planned_run.hpp"
#include "io/scene/scene.hpp"

namespace talus {

/// What a search needs to know of the scene, all of it checked.
struct FosPlan {
  std::filesystem::path scene, folder;
  std::vector<std::string> set;  ///< the user's changes
  bool quick = false;
  PlannedRun at_rest;                  ///< all stages up to the last that seeks rest
  std::vector<std::string> bodies;     ///< whose strength is divided
  std::vector<Index> materials;        ///< their numbers in the scene
  Scene spec;                          ///< with the user's changes
  std::vector<std::string> of_state;   ///< changes of every trial: bodies, walls, initial
  std::string fields, moved, picture;  ///< of the outputs of every trial
  std::vector<std::string> columns;    ///< of the history: how far the bodies have moved
  bool keeps_strain = false;           ///< laws of these bodies remember plastic strain
  AtRest before;
  Real duration = 0, damping = 0;  ///< of a trial
};

/// Makes the mesh and the model of the scene.  SceneErrors with all that is wrong with the scene, or keeps its strength from being divided.
FosPlan plan_fos(const FosOptions& options);

/// The run of a factor, so many times as long as the plan says.
PlannedRun trial_of(const FosPlan& plan, Real factor, int times_as_long);

/// Parameters that the division changes: "materials[0].cohesion=9975".
std::vector<std::string> divided(const FosPlan& plan, Real factor);

}  // namespace talus
