#pragma once
// Command talus converge.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

struct ConvergeOptions {
  std::filesystem::path scene;
  std::vector<std::string> set;
  std::optional<std::filesystem::path> out;
  Real ratio = 1.4142135623730951;   ///< size of the cells of a level over those of the next finer one
  int levels = 3;                    ///< number of levels
  int finer = 0;                     ///< number of levels that are finer than the scene; the others have its cells, or larger ones
  std::vector<std::string> collect;  ///< names of numbers, as in a study; empty: all physical ones
  std::optional<Real> within;        ///< largest uncertainty of the collected numbers over their values [-]
  std::optional<int> jobs, threads;
  std::optional<std::string> launcher;
  bool list = false;  ///< run nothing
  bool json = false;  ///< print convergence.json instead of the table
  bool quick = false, quiet = false;
};
/// Runs the scene with cells of several sizes, each in its own process and folder, and tells how far its numbers depend on them; writes
/// convergence.csv and convergence.json.  Throws SceneErrors with all errors before anything runs; RunError if a level failed, or if a
/// number is not within `within`; Stopped; EnvironmentError.
void converge(const ConvergeOptions& options);

}  // namespace talus
