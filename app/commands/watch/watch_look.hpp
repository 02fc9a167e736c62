#pragma once
// What is to be seen of a run in its folder at one moment, in words.
#include "app/commands/report/report.hpp"
#include "io/output/progress_json.hpp"

namespace talus {

/// Files of a run that are there so far.
struct RunFiles {
  std::vector<std::pair<Real, std::filesystem::path>> frames;  ///< of the particles, with their times [s]
  std::vector<std::filesystem::path> pictures;                 ///< the newest first
};

struct RunLook {
  RunState state = RunState::at_work;
  std::optional<RunProgress> progress;
  HistoryTable history;
  RunFiles files;
  std::vector<std::string> left_out;  ///< files that cannot be read, each with the reason
  std::string marks;                  ///< changes when any of the files does
};

/// Looks at the folder; what has not changed since `before` is taken from there.
RunLook look_at(const RunFolder& run, const RunLook& before);

/// Title, how far it is, balances so far, files: lines without colours.
std::vector<std::string> described(const RunFolder& run, const RunLook& look);
/// One line, for logs.
std::string in_one_line(const RunFolder& run, const RunLook& look);

}  // namespace talus
