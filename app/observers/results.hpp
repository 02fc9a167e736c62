#pragma once
// The results folder of a run: its lock and its contents.  For making and replacing it see new_results.hpp.
#include <filesystem>

#include "io/files/file_descriptor.hpp"
#include "io/files/result_files.hpp"

namespace talus {

/// Keeps other runs out of a folder while it exists, as they would remove each other's results.  Without effect on file systems that do not
/// support locks.
class FolderLock {
 public:
  FolderLock() = default;
  /// Throws EnvironmentError if another run has locked the folder.
  explicit FolderLock(const std::filesystem::path& folder);

 private:
  FileDescriptor handle_;  // of the folder itself: no lock file is needed
};

/// Whether a run has locked the folder.  False if the file system does not support locks.
bool run_is_at_work(const std::filesystem::path& folder);

/// Whether `source` lies in `folder` or below.
bool lies_in(const std::filesystem::path& source, const std::filesystem::path& folder);

/// Throws Error if the folder does not contain the results of a run.
void require_run(const std::filesystem::path& folder);

/// Throws EnvironmentError if the folder of a run has been removed or replaced.  Otherwise the remaining files would be written to a new,
/// incomplete folder, and the history to a file without a name.
void require_results(const std::filesystem::path& folder);

/// Removes the temporary files of a killed run.  Files of the user stay.
void remove_leftovers(const std::filesystem::path& folder);

/// The default folder runs/<name>, with the name of the scene's folder, or of the file if that is not called scene.yaml.
std::filesystem::path default_results(const std::filesystem::path& scene);

}  // namespace talus
