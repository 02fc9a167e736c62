#pragma once
// Command talus fos.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/commands/fos/fos_search.hpp"

namespace talus {

/// What a trial is: a run with inertia, or increments each of which is solved for equilibrium.
enum class TrialKind : std::uint8_t { run, equilibrium };

struct FosOptions {
  std::filesystem::path scene;
  std::vector<std::string> set;
  std::optional<std::filesystem::path> out;
  FosRange range;
  FosCriterion criterion;                   ///< its limit of growth; the others are in the plan
  std::optional<Real> kinetic, steadiness;  ///< limits of runs and of equilibria
  std::optional<TrialKind> trials;          ///< default as the stage that finds the state at rest
  std::optional<Real> duration;             ///< duration of a run [s]
  std::optional<Real> damping;              ///< local damping of a run, as in stages; default 0.3
  std::optional<int> increments;            ///< of a trial that is solved for equilibrium; default 6
  Real mass_share = 0.99;                   ///< fraction of mass whose displacement is measured, as in outputs.history.moved
  std::vector<std::string> bodies;          ///< bodies whose strength is divided; empty: all with a strength
  std::optional<int> jobs, threads;
  std::optional<std::string> launcher;
  bool quick = false, quiet = false, pictures = true;
};
/// Finds the factor by which the strength of bodies can be divided before they fail: runs the scene until it is in equilibrium, then trials
/// from there, and writes fos.csv, fos.json and pictures.  Throws SceneErrors, RunError, Stopped, EnvironmentError.
void find_fos(const FosOptions& options);

}  // namespace talus
