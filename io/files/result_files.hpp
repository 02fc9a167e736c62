#pragma once
// Names of the files and folders that Talus writes into a results folder; among them the maps of a run with outputs.runout, with their contents.
#include <array>
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

struct MapKind {
  std::string_view name;   ///< name of the file without its ending, and of the column of a section
  std::string_view title;  ///< title in pictures
  std::string_view unit;
};

/// All kinds of maps.  Maps of the ground are surfaces to draw on; the others have a value only where material has moved.
inline constexpr std::array map_kinds{
    MapKind{"ground", "ground before", "m"},        MapKind{"base", "base", "m"},
    MapKind{"surface", "surface after", "m"},       MapKind{"surface_max", "highest surface", "m"},
    MapKind{"thickness", "deposit thickness", "m"}, MapKind{"thickness_max", "largest thickness", "m"},
    MapKind{"speed_max", "largest speed", "m/s"},   MapKind{"intensity_max", "largest intensity h v^2", "m^3/s^2"},
    MapKind{"arrival", "time of arrival", "s"},     MapKind{"source", "depth that has left", "m"},
    MapKind{"erosion", "depth of erosion", "m"}};

constexpr bool is_surface(std::string_view map) { return map == "ground" || map == "base" || map == "surface" || map == "surface_max"; }

}  // namespace talus
