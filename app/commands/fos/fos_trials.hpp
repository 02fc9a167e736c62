#pragma once
// The runs of a search for a factor of safety: one that finds equilibrium, and trials that start from it with divided strength.
#include "app/commands/fos/fos_command.hpp"
#include "app/commands/queue/planned_run.hpp"
#include "io/scene/scene.hpp"

namespace talus {

/// The checked information on the scene that a search needs.
struct FosPlan {
  std::filesystem::path scene, folder;
  std::vector<std::string> set;  ///< changes by the user
  bool quick = false;
  PlannedRun at_rest;                  ///< all stages up to the last one that seeks equilibrium
  std::vector<std::string> bodies;     ///< bodies whose strength is divided
  std::vector<Index> materials;        ///< indices of their materials in the scene
  Scene spec;                          ///< including the changes by the user
  std::vector<std::string> of_state;   ///< changes of every trial: bodies, walls, initial
  std::string fields, moved, picture;  ///< changes of the outputs of every trial
  std::vector<std::string> columns;    ///< columns of the history with the displacement of the bodies
  bool keeps_strain = false;           ///< whether laws of these bodies store plastic strain
  AtRest before;
  TrialKind trials = TrialKind::run;
  FosCriterion criterion;
  Real duration = 0;  ///< of a trial [s], in equilibria one for each increment
  std::string stage;  ///< of a trial, without its duration
};

/// Makes the mesh and the model of the scene.  Throws SceneErrors with all errors of the scene, and with reasons why its strength cannot be
/// divided.
FosPlan plan_fos(const FosOptions& options);

/// The run for a factor, with its duration multiplied by `times_as_long`.
PlannedRun trial_of(const FosPlan& plan, Real factor, int times_as_long);

/// The parameters changed by the division, such as "materials[0].cohesion=9975".
std::vector<std::string> divided(const FosPlan& plan, Real factor);

}  // namespace talus
