#pragma once
// Command talus fos.
#include <filesystem>
#include <string>
#include <vector>

namespace talus {

struct FosOptions {
  std::filesystem::path scene;
  std::vector<std::string> words;  ///< options of the Python package with their values, such as "--width=0.02"
};
/// Replaces this process by `fos` of the Python package talus, which runs this program.  Throws Error if it was started on several ranks,
/// EnvironmentError.
[[noreturn]] void find_fos(const FosOptions& options);

}  // namespace talus
