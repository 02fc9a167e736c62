#pragma once
// The folder of a run: made, emptied of an older run's results, and known to be writable before anything is computed.
#include <filesystem>
#include <string>

namespace talus {

/// In the folder of a run.
inline constexpr auto checkpoint_folder = "checkpoints";
/// There too: the state of another run that this one began with, to go on without that run.
inline constexpr auto initial_file = "initial.h5";

/// Makes `folder`, or clears it if it holds the results of an earlier run (it has a summary.json).
/// EnvironmentError: it cannot be written, or holds something else, which is left alone.
void prepare_results(const std::filesystem::path& folder);

/// EnvironmentError: a run's folder is not there any more, or another has taken its place.  Without asking, its files would be made anew, each
/// alone in an empty folder, and its history go on in a file that nobody finds.
void require_results(const std::filesystem::path& folder);

/// Removes what a run that was killed had not finished writing.
void remove_leftovers(const std::filesystem::path& folder);

/// runs/<name>: name of the scene's folder, or of the file if that is not called scene.yaml.
std::filesystem::path default_results(const std::filesystem::path& scene);

}  // namespace talus
