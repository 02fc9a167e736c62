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
  std::optional<std::filesystem::path> resume;  ///< a checkpoint, or the folder of a run, instead of the scene
  std::optional<std::int64_t> until;            ///< stop before the step after this one, with a checkpoint
  std::optional<int> threads;
  std::optional<std::int64_t> rebalance;  ///< ranks share the run out anew every so many steps; 0: never; default: when it pays
  std::vector<std::string> set;
  bool quick = false, quiet = false;
  bool strict = false;  ///< as the scene's key of this name
  bool dry = false;     ///< only tell what the run would cost
  bool force = false;   ///< replace a run that could go on
};
/// Runs a scene, or goes on with one, and leaves its results in a folder.  SceneErrors, RunError, EnvironmentError; Stopped by a signal or
/// where it was to stop.
void run_scene(const RunOptions& options);

/// Makes a few steps, writes nothing, says what the run would cost in memory, files and time.  SceneErrors, RunError.
void dry_run(const RunOptions& options);

}  // namespace talus
