#pragma once
// Names of the files and folders that Talus writes into a folder of results.
#include <string_view>

namespace talus {

/// Folders within that of a run.
inline constexpr auto checkpoint_folder = "checkpoints", map_folder = "maps", section_folder = "sections", picture_folder = "pictures";
/// The state of another run that this one began with, to go on without that run.
inline constexpr auto initial_file = "initial.h5";
/// How far a run is, while it is at work; and its page, which talus report writes.
inline constexpr auto progress_file = "progress.json";
inline constexpr auto report_file = "report.html";

/// prefix, digits, suffix.
bool is_numbered(std::string_view name, std::string_view prefix, std::string_view suffix) noexcept;

/// Whether a run may write a file of that name, which is relative to its folder: a file of the user must not bear it.
bool is_written_by_runs(std::string_view name) noexcept;

/// Whether Talus may write a file of that name: runs, pictures and pages of them.
bool is_result(std::string_view name) noexcept;

}  // namespace talus
