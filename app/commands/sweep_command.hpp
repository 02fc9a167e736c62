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
/// Replaces this process by `sweep` of the Python package talus, which runs this program.  Throws Error if it was started on several ranks,
/// EnvironmentError.
[[noreturn]] void sweep(const SweepOptions& options);

}  // namespace talus
