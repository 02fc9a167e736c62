#pragma once
// The results folder of a new run: checked before the first step, prepared beside existing results, and put in place by renaming.
#include <filesystem>
#include <optional>

#include "app/observers/results.hpp"

namespace talus {

/// How a new run may treat an existing folder.
struct Replacing {
  bool force = false;                                         ///< whether it may replace a run that could be resumed
  std::optional<std::filesystem::path> scene = std::nullopt;  ///< file of the scene; it is not replaced if it is the one in the folder
};

/// Throws EnvironmentError if the folder cannot take the results of a new run: it cannot be written, another run is at work in it, it
/// contains other files than results, a run in it could be resumed, or files would be replaced that no run wrote or that were changed
/// since.
void check_replaceable(const std::filesystem::path& folder, const Replacing& how);

/// The bytes of the files in a folder that a new run replaces or removes.
std::uintmax_t bytes_replaced(const std::filesystem::path& folder);

/// The first files of a new run.  Until commit() the contents of the folder are unchanged.  If the program is killed at any time, files of
/// the user stay, and all others are in the list.
class NewResults {
 public:
  /// Makes the folder, or locks it and calls check_replaceable() again.
  NewResults(std::filesystem::path folder, Replacing how);
  ~NewResults();
  NewResults(const NewResults&) = delete;
  NewResults& operator=(const NewResults&) = delete;

  /// The folder for the first files.
  const std::filesystem::path& staging() const noexcept { return staging_; }
  /// Whether the scene of the run is the one in the folder, which is then not written.
  bool keeps_scene() const noexcept { return keeps_scene_; }
  /// Moves the files into the folder and removes other files of an earlier run.
  [[nodiscard]] FolderLock commit();

 private:
  void leave_as_it_was() const noexcept;

  std::filesystem::path folder_, staging_;
  bool made_ = false, keeps_scene_ = false, done_ = false;
  FolderLock lock_;
};

/// Adds the results in a folder to its list, for runs by a version of Talus without lists.
void adopt_results(const std::filesystem::path& folder);

}  // namespace talus
