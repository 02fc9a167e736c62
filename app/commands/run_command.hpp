#pragma once
// Command talus run.
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace talus {

struct RunOptions {
  std::filesystem::path scene;
  std::optional<std::filesystem::path> out;
  std::optional<std::filesystem::path> resume;  ///< a checkpoint, or a results folder, instead of the scene
  std::optional<std::int64_t> until;            ///< stop after this number of steps, with a checkpoint
  std::optional<int> threads;
  std::optional<std::int64_t> rebalance;  ///< ranks redistribute the work after so many steps; 0: never; default: when it pays
  std::vector<std::string> set;
  bool quick = false, quiet = false;
  bool strict = false;  ///< as the key of this name in the scene
  bool dry = false;     ///< print only the cost of the run
  bool force = false;   ///< replace a run that could be resumed
};
/// Runs a scene, or resumes a run, and writes its results into a folder.  Throws SceneErrors, RunError, EnvironmentError; Stopped after a
/// signal or at the requested step.
void run_scene(const RunOptions& options);

/// Makes a few steps, writes nothing, and prints the cost of the run in memory, files and time.  Throws SceneErrors, RunError.
void dry_run(const RunOptions& options);

}  // namespace talus
