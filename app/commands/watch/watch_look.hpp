#pragma once
// The state of a run according to its folder, as text.
#include "app/commands/report/report.hpp"
#include "io/output/progress_json.hpp"

namespace talus {

/// The present files of a run.
struct RunFiles {
  std::vector<std::pair<Real, std::filesystem::path>> frames;  ///< particle files with their times [s]
  std::vector<std::filesystem::path> pictures;                 ///< the newest first
};

struct RunLook {
  RunState state = RunState::at_work;
  std::optional<RunProgress> progress;
  HistoryTable history;
  RunFiles files;
  std::vector<std::string> left_out;  ///< unreadable files with the reason
  std::string marks;                  ///< changes when any of the files changes
};

/// Reads the state from the folder; data that have not changed are taken from `before`.
RunLook look_at(const RunFolder& run, const RunLook& before);

/// Title, progress, balances, files: lines without colours.
std::vector<std::string> described(const RunFolder& run, const RunLook& look);
/// The state on one line, for logs.
std::string in_one_line(const RunFolder& run, const RunLook& look);

}  // namespace talus
