#pragma once
// The folder of a run: whose it is, and what is known of it.  How it is made and refilled: new_results.hpp.
#include <filesystem>
#include <utility>

#include "io/files/result_files.hpp"

namespace talus {

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

/// True if `source` lies in `folder` or below.
bool lies_in(const std::filesystem::path& source, const std::filesystem::path& folder);

/// Error: no run has left its results there.
void require_run(const std::filesystem::path& folder);

/// EnvironmentError: a run's folder is not there any more, or another has taken its place.  Without asking, its files would be made anew, each
/// alone in an empty folder, and its history go on in a file that nobody finds.
void require_results(const std::filesystem::path& folder);

/// Removes what a run that was killed had not finished writing.  Files of the user stay.
void remove_leftovers(const std::filesystem::path& folder);

/// runs/<name>: name of the scene's folder, or of the file if that is not called scene.yaml.
std::filesystem::path default_results(const std::filesystem::path& scene);

}  // namespace talus
