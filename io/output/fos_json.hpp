#pragma once
// fos.json: the factor of safety of a scene, the criteria, and the trials.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

struct FosTrialRecord {
  Real factor{};
  std::string verdict, message;
  std::optional<Real> moved, growth, liveliness, steadiness, duration;  ///< [m, -, -, -, s]; nothing if the run ended early
  bool by_growth_alone{};
  std::string folder, command, scene_digest;
};

struct FosRecord {
  std::string scene, commit;
  std::optional<Real> factor, low, high;  ///< nothing while the search continues
  std::vector<Real> out_of_order;
  Real width{}, growth_limit{}, liveliness_limit{}, steadiness_limit{};
  Real settlement{}, height{};  ///< m
  std::vector<std::string> bodies;
  std::vector<FosTrialRecord> trials;
};

/// Writes the file atomically.  Throws EnvironmentError.
void write_fos(const std::filesystem::path& file, const FosRecord& record);

/// The scene digests of the trials in an existing file whose run ended early; empty if it cannot be read.
std::vector<std::string> broken_off(const std::filesystem::path& file);

}  // namespace talus
