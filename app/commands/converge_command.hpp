#pragma once
// Command talus converge.
#include <filesystem>
#include <string>
#include <vector>

namespace talus {

struct ConvergeOptions {
  std::filesystem::path scene;
  std::vector<std::string> words;  ///< options of the Python package with their values, such as "--ratio=2"
};
/// Replaces this process by `converge` of the Python package talus, which runs this program.  Throws Error if it was started on several
/// ranks, EnvironmentError.
[[noreturn]] void converge(const ConvergeOptions& options);

}  // namespace talus
