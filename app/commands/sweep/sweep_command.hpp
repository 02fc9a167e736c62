#pragma once
// Command talus sweep.
#include <filesystem>
#include <optional>
#include <string>

namespace talus {

struct SweepOptions {
  std::filesystem::path study;
  std::optional<std::filesystem::path> out;
  std::optional<int> jobs, threads;     ///< runs at a time; threads of each
  std::optional<int> only;              ///< number of the one case to run
  std::optional<std::string> launcher;  ///< words before the program, such as "mpirun -n 4"
  bool list = false;                    ///< run nothing
  bool quick = false, quiet = false, pictures = true;
};
/// Runs the cases of a study that are not done yet, each as a process of its own in a folder of its own, and keeps a table of them.  SceneErrors
/// with all that is wrong with any case, before anything runs; RunError if some failed; Stopped by a signal, or because cases were; EnvironmentError.
void sweep(const SweepOptions& options);

}  // namespace talus
