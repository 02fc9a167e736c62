#pragma once
// Messages of a run on the terminal.
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "app/commands/run_command.hpp"
#include "app/run/simulate.hpp"
#include "app/setup/stage_changes.hpp"

namespace talus {

/// The changes by a stage, as lines for the summary; warnings are added to those of the run.  The root prints them, the former unless it is
/// `quiet`.
std::vector<std::string> tell_changes(Real time, std::string_view stage, const StageReport& news, bool quiet,
                                      std::vector<std::string>& warnings);

/// The warning about checkpoints that were renamed, because they are newer than the one that the run resumes from.
std::string tell_set_aside(const std::filesystem::path& taken, const std::vector<std::filesystem::path>& aside);

/// The command that computes the state after step `sound` of a failed run again, from its scene or from its checkpoints, if it has some.
std::string tell_way_back(const RunOptions& options, const std::filesystem::path& folder, bool quick, bool has_checkpoint,
                          std::int64_t sound);

/// Prints a redistribution, on the root.
void say_rebalanced(const Rebalanced& by);

}  // namespace talus
