#pragma once
// Commands that are written in the Python package talus.
#include <string>
#include <vector>

namespace talus {

struct PackageCommand {
  std::string name;
  std::vector<std::string> words;  ///< files, and options with their values, such as "--ratio=2"
  bool starts_runs = true;         ///< of this program
};
/// Replaces this process by a command of the package, which may run this program.  Throws Error if it starts runs and was itself started on
/// several ranks, EnvironmentError where the package or Python is missing.
[[noreturn]] void run_in_package(const PackageCommand& command);

}  // namespace talus
