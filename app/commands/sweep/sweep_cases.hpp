#pragma once
// The cases of a study: their scenes, what is wrong with them before anything runs, and how far each has come.
#include "app/commands/sweep/planned_run.hpp"
#include "io/scene/study.hpp"

namespace talus {

struct SweepCase : PlannedRun {
  int number = 0;  ///< from 1
  StudyCase values;
};

/// What is to be done with the cases of a study, and where.
struct SweepPlan {
  Study study;
  std::filesystem::path folder;
  bool quick = false;
  std::vector<SweepCase> cases;
  std::vector<std::string> fronts;  ///< of the histories of any case: how far bodies run out
};

/// Reads the scene of every case.  SceneErrors: all that is wrong with any of them, at the value in the study that made it so.
SweepPlan plan_sweep(Study study, std::filesystem::path folder, bool quick);

enum class CheckDepth : std::uint8_t { mesh, all };
/// Makes or reads the meshes of these cases and sets their digests; with `all` builds the model of each that would begin anew.  SceneErrors
/// with all that is wrong.
void check_cases(SweepPlan& plan, const std::vector<std::size_t>& chosen, CheckDepth depth);

}  // namespace talus
