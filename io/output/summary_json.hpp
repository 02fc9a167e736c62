#pragma once
// Reads summary.json: status of a run, and its numbers by name.
#include <filesystem>
#include <string>
#include <vector>

#include "io/output/run_summary.hpp"

namespace talus {

struct SummaryBack {
  std::string status, message, title, scene_file;  ///< empty if not in the file
  std::vector<std::string> overrides, warnings;    ///< changes of the scene by --set; warnings of the run
  std::vector<BodySummary> bodies;                 ///< without masses
  std::string text;                                ///< text of the file
  std::vector<NamedValue> numbers;                 ///< with the path of their keys without units, such as "balances.energy.terms.plastic"
};

/// Throws EnvironmentError with the name of the file if it cannot be read or is not a summary of a run.
SummaryBack read_summary(const std::filesystem::path& file);

/// The number of that name, or the only one whose path ends with it, such as "energy.closure" or "plastic".
const NamedValue* find_number(const std::vector<NamedValue>& numbers, std::string_view name);

}  // namespace talus
