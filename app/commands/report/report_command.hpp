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
  std::optional<std::filesystem::path> page;  ///< template; default the one beside the program
  std::vector<std::string> fields;            ///< empty: that of the pictures, then all that were written
  std::optional<int> frames;                  ///< so many
  std::optional<Real> size;                   ///< of the page at most [MB]
};
/// Makes one page for the browser of what is in the folder of a run, ended or not, and says what it leaves out.  Error: there is no run, or
/// what was asked for; EnvironmentError.
void write_report(const ReportOptions& options);

}  // namespace talus
