#pragma once
// Command talus diff.
#include <filesystem>
#include <string>
#include <vector>

namespace talus {

struct DiffOptions {
  std::filesystem::path a, b;      ///< results folders of two runs
  std::vector<std::string> words;  ///< options of the Python package with their values, such as "--relative=1e-6"
};
/// Replaces this process by `diff` of the Python package talus.  Throws EnvironmentError.
[[noreturn]] void compare_results(const DiffOptions& options);

}  // namespace talus
