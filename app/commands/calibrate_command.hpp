#pragma once
// Command talus calibrate.
#include <filesystem>
#include <optional>

namespace talus {

struct CalibrateOptions {
  std::filesystem::path specification;
  std::optional<std::filesystem::path> out;
  std::optional<int> jobs, threads;
  bool pictures = true, quiet = false;
};
/// Replaces this process by `calibrate` of the Python package talus, which runs this program.  Throws EnvironmentError.
[[noreturn]] void calibrate(const CalibrateOptions& options);

}  // namespace talus
