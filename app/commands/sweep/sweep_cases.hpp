#pragma once
// The cases of a study: their scenes, errors before anything runs, and the progress of each.
#include "app/commands/sweep/planned_run.hpp"
#include "io/scene/study.hpp"

namespace talus {

struct SweepCase : PlannedRun {
  int number = 0;  ///< counted from 1
  StudyCase values;
};

/// The cases of a study, and the folder for them.
struct SweepPlan {
  Study study;
  std::filesystem::path folder;
  bool quick = false;
  std::vector<SweepCase> cases;
  std::vector<std::string> fronts;  ///< columns of run-out in the histories of all cases
};

/// Reads the scene of every case.  Throws SceneErrors with all errors, at the values in the study that cause them.
SweepPlan plan_sweep(Study study, std::filesystem::path folder, bool quick);

enum class CheckDepth : std::uint8_t { mesh, all };
/// Makes or reads the meshes of these cases and sets their digests; with `all` builds the model of each case that would start anew.  Throws
/// SceneErrors with all errors.
void check_cases(SweepPlan& plan, const std::vector<std::size_t>& chosen, CheckDepth depth);

}  // namespace talus
