#pragma once
// summary.json read back: how a run ended, what it was made from, and its numbers by name.
#include <filesystem>
#include <string>
#include <vector>

#include "io/output/run_summary.hpp"

namespace talus {

struct SummaryBack {
  std::string status, message, commit, scene_digest, mesh_digest;  ///< empty where the file does not say
  std::string title, scene_file;
  std::vector<std::string> overrides, warnings;  ///< what --set changed of the scene; what the run warned of
  std::vector<BodySummary> bodies;               ///< without their masses
  std::string text;                              ///< of the file
  bool quick = false;                            ///< ended as a quick run
  std::vector<NamedValue> numbers;               ///< by the path of their keys without units, such as "balances.energy.terms.plastic"
};

/// EnvironmentError naming the file: it cannot be read, or is no summary of a run.
SummaryBack read_summary(const std::filesystem::path& file);

/// The number of that name; or the only one whose path ends in it, such as "energy.closure" or "plastic".
const NamedValue* find_number(const std::vector<NamedValue>& numbers, std::string_view name);

}  // namespace talus
