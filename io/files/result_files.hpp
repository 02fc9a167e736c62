#pragma once
// Names of the files and folders that Talus writes into a results folder.
#include <string_view>

namespace talus {

/// Folders in the results folder.
inline constexpr auto checkpoint_folder = "checkpoints", map_folder = "maps", section_folder = "sections", picture_folder = "pictures";
/// The state of another run with which this one began, so that it can be resumed without that run.
inline constexpr auto initial_file = "initial.h5";
/// The progress of a run in progress; and its page, which talus report writes.
inline constexpr auto progress_file = "progress.json";
inline constexpr auto report_file = "report.html";

/// Whether a name consists of prefix, digits and suffix.
bool is_numbered(std::string_view name, std::string_view prefix, std::string_view suffix) noexcept;

/// Whether a run may write a file of that name, relative to its folder; files of the user must not have such names.
bool is_written_by_runs(std::string_view name) noexcept;

/// Whether Talus may write a file of that name: runs, pictures and reports.
bool is_result(std::string_view name) noexcept;

}  // namespace talus
