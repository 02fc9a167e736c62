#pragma once
// fos.json: the factor of safety of a scene, how it was judged, and the trials.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

struct FosTrialRecord {
  Real factor{};
  std::string verdict, message;
  std::optional<Real> moved, growth, liveliness, duration;  ///< m, -, -, s; nothing where the run broke off
  bool by_growth_alone{};
  std::string folder, command, scene_digest;
};

struct FosRecord {
  std::string scene, commit;
  std::optional<Real> factor, low, high;  ///< nothing while the search goes on
  std::vector<Real> out_of_order;
  Real width{}, growth_limit{}, liveliness_limit{};
  Real settlement{}, height{};  ///< m
  std::vector<std::string> bodies;
  std::vector<FosTrialRecord> trials;
};

/// Writes the file as a whole.  EnvironmentError.
void write_fos(const std::filesystem::path& file, const FosRecord& record);

/// Scene digests of the trials whose run broke off, of a file that is there; what cannot be read has none.
std::vector<std::string> broken_off(const std::filesystem::path& file);

}  // namespace talus
