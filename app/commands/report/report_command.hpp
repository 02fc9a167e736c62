#pragma once
// Command talus report.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

struct ReportOptions {
  std::filesystem::path folder;
  std::optional<std::filesystem::path> out;   ///< default DIR/report.html
  std::optional<std::filesystem::path> page;  ///< template; default: the one beside the program
  std::vector<std::string> fields;            ///< empty: the field of the pictures, then all that were written
  std::optional<int> frames;                  ///< number of frames
  std::optional<Real> size;                   ///< largest size of the page [MB]
};
/// Makes a page for the browser from a results folder, also of a run that has not ended, and prints what it leaves out.  Throws Error if
/// there is no run or a requested item is missing; EnvironmentError.
void write_report(const ReportOptions& options);

}  // namespace talus
