#pragma once
// Command talus drive.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

struct DriveOptions {
  std::filesystem::path file;  ///< of a material and paths; with `test`, a scene
  std::vector<std::string> set;
  std::optional<std::filesystem::path> out, plot;
  std::optional<std::string> test, material;  ///< standard test, on this material of the scene
  std::optional<Real> pressure, strain, rate;
  std::optional<Index> steps;
};
/// Drives the law of a file along its paths; CSV to `out`, or to standard output.
/// With a test: runs it on a material of a scene, prints strengths beside closed forms; CSV to `out` and a picture to `plot` if asked to
/// (a picture leaves the CSV it was drawn from beside it).
void drive_law(const DriveOptions& options);

}  // namespace talus
