#pragma once
// Command talus fos.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/commands/fos/fos_search.hpp"

namespace talus {

struct FosOptions {
  std::filesystem::path scene;
  std::vector<std::string> set;
  std::optional<std::filesystem::path> out;
  FosRange range;
  FosCriterion criterion;
  std::optional<Real> duration;     ///< of a trial [s]
  Real damping = 0.3;               ///< of a trial, as stages have it
  Real mass_share = 0.99;           ///< whose displacement counts, as outputs.history.moved has it
  std::vector<std::string> bodies;  ///< whose strength is divided; empty: of all that have some
  std::optional<int> jobs, threads;
  std::optional<std::string> launcher;
  bool quick = false, quiet = false, pictures = true;
};
/// Finds the factor by which the strength of bodies can be divided before they fail: runs the scene until it is at rest, then trials from there, and
/// leaves fos.csv, fos.json and pictures.  SceneErrors, RunError, Stopped, EnvironmentError as above.
void find_fos(const FosOptions& options);

}  // namespace talus
