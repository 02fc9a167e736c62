#pragma once
// The folder of a run: made, emptied of an older run's results, and known to be writable before anything is computed.
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

namespace talus {

/// In the folder of a run.
inline constexpr auto checkpoint_folder = "checkpoints";
/// There too: maps over the plan, and sections through them.
inline constexpr auto map_folder = "maps", section_folder = "sections";
/// There too: the state of another run that this one began with, to go on without that run.
inline constexpr auto initial_file = "initial.h5";

/// How far a run is, while it is at work; and its page, which talus report writes.
inline constexpr auto progress_file = "progress.json";
inline constexpr auto report_file = "report.html";

/// prefix, digits, suffix.
bool is_numbered(std::string_view name, std::string_view prefix, std::string_view suffix) noexcept;

/// Keeps other runs out of a folder while it lives: they would take each other's results away.  Where the file system knows no such locks
/// there is none.
class FolderLock {
 public:
  FolderLock() = default;
  /// EnvironmentError: another run has the folder.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept : handle_(std::exchange(other.handle_, -1)) {}
  FolderLock& operator=(FolderLock&& other) noexcept
  {
    std::swap(handle_, other.handle_);
    return *this;
  }

 private:
  int handle_ = -1;  // of the folder itself: no file is left behind
};

/// Whether a run has the folder now.  False where the file system knows no locks.
bool run_is_at_work(const std::filesystem::path& folder);

/// Makes `folder`, or clears it if it holds the results of an earlier run (it has a summary.json).
/// EnvironmentError: it cannot be written, another run is at work in it, or it holds something else, which is left alone.
[[nodiscard]] FolderLock prepare_results(const std::filesystem::path& folder);

/// True if clearing `folder` for results may take `source` away.
bool lies_in(const std::filesystem::path& source, const std::filesystem::path& folder);

/// Error: no run has left its results there.
void require_run(const std::filesystem::path& folder);

/// EnvironmentError: a run's folder is not there any more, or another has taken its place.  Without asking, its files would be made anew, each
/// alone in an empty folder, and its history go on in a file that nobody finds.
void require_results(const std::filesystem::path& folder);

/// Removes what a run that was killed had not finished writing.
void remove_leftovers(const std::filesystem::path& folder);

/// runs/<name>: name of the scene's folder, or of the file if that is not called scene.yaml.
std::filesystem::path default_results(const std::filesystem::path& scene);

}  // namespace talus
