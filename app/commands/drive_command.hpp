#pragma once
// Command talus drive.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

struct DriveOptions {
  std::filesystem::path file;  ///< a material and paths; with `test`, a scene
  std::vector<std::string> set;
  std::optional<std::filesystem::path> out, plot;
  std::optional<std::string> test, material;  ///< name of a standard test, and a material of the scene
  std::optional<Real> pressure, strain, rate;
  std::optional<Index> steps;
};
/// Drives the law of a file along its paths; writes CSV to `out`, or to standard output.  With a test: runs it on a material of a scene and
/// prints strengths beside closed forms; optionally writes CSV to `out` and a picture to `plot`, with its CSV beside it.
void drive_law(const DriveOptions& options);

}  // namespace talus
