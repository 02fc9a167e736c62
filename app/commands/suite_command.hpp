#pragma once
// Command talus verify and talus tradeoff.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace talus {

struct SuiteOptions {
  std::string suite;  ///< verify or tradeoff
  std::vector<std::string> cases;
  std::optional<std::string> level, kernel, transfer;
  std::optional<std::filesystem::path> out;
  std::optional<int> jobs, threads;
  bool reuse = false, regression = false;
};
/// Replaces this process by the suite of benchmarks/, which runs this program.  Throws EnvironmentError.
[[noreturn]] void run_suite(const SuiteOptions& options);

}  // namespace talus
