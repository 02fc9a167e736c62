#pragma once
// The folder that a new run fills: examined before anything is computed, laid out beside what is there, and put in its place by renaming.
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "app/observers/results.hpp"

namespace talus {

/// How a new run may treat a folder that is there.
struct Replacing {
  bool force = false;                                         ///< a run that could go on as well
  std::optional<std::filesystem::path> scene = std::nullopt;  ///< file of the scene that is run: it stays where it is the folder's own
};

/// EnvironmentError: the folder cannot take the results of a new run.  It cannot be written, another run is at work in it, it holds something
/// else than results, a run in it could go on, or files in it that no run wrote, or that were changed since, would be replaced.
void check_replaceable(const std::filesystem::path& folder, const Replacing& how);

/// Bytes of the files in a folder that a new run replaces or removes.
std::uintmax_t bytes_replaced(const std::filesystem::path& folder);

/// The first files of a new run.  Until commit() what was in the folder is as it was.  Whatever kills the program, and whenever: files that no
/// run wrote stay, the others are known as those of runs.
class NewResults {
 public:
  /// Makes the folder, or locks it and asks check_replaceable() once more.
  NewResults(std::filesystem::path folder, Replacing how);
  ~NewResults();
  NewResults(const NewResults&) = delete;
  NewResults& operator=(const NewResults&) = delete;

  /// Where to write the first files.
  const std::filesystem::path& staging() const noexcept { return staging_; }
  /// Whether the scene of the folder is that which is run: then it is not written.
  bool keeps_scene() const noexcept { return keeps_scene_; }
  /// Puts them into the folder and removes what other files an earlier run left there.
  [[nodiscard]] FolderLock commit();

 private:
  void leave_as_it_was() const noexcept;

  std::filesystem::path folder_, staging_;
  bool made_ = false, keeps_scene_ = false, done_ = false;
  FolderLock lock_;
};

/// Takes the files that a run has in its folder for those that it wrote, where a version of Talus that kept no list of them did so.
void adopt_results(const std::filesystem::path& folder);

}  // namespace talus
