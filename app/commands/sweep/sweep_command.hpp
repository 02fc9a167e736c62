#pragma once
// Command talus sweep.
#include <filesystem>
#include <optional>
#include <string>

namespace talus {

struct SweepOptions {
  std::filesystem::path study;
  std::optional<std::filesystem::path> out;
  std::optional<int> jobs, threads;     ///< number of simultaneous runs; threads of each
  std::optional<int> only;              ///< number of the one case to run
  std::optional<std::string> launcher;  ///< words before the program, such as "mpirun -n 4"
  bool list = false;                    ///< run nothing
  bool quick = false, quiet = false, pictures = true;
};
/// Runs the cases of a study that are not done yet, each in its own process and folder, and maintains a table of them.  Throws SceneErrors
/// with all errors of the cases before anything runs; RunError if some failed; Stopped after a signal, or because cases were stopped;
/// EnvironmentError.
void sweep(const SweepOptions& options);

}  // namespace talus
