#include "app/run/new_results.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <new>
#include <vector>

#include "core/display_text.hpp"
#include "core/error.hpp"
#include "io/files/manifest.hpp"
#include "io/output/summary_json.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

constexpr auto scene_file = "scene.yaml", summary_file = "summary.json";
/// Folders in which runs write files; pictures are written by other commands.
constexpr std::array<const char*, 3> folders_of_runs{checkpoint_folder, map_folder, section_folder};

/// Whether a folder is empty, apart from temporary files of a killed run.
bool holds_nothing(const fs::path& folder)
{
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().filename() != own_folder)
      return false;
  return true;
}

/// Throws EnvironmentError if the folder lies in the results folder of another run.
void check_place(const fs::path& folder)
{
  for (fs::path inner = fs::weakly_canonical(folder); inner != inner.parent_path(); inner = inner.parent_path())
    for (const std::string_view name : {checkpoint_folder, map_folder, section_folder, picture_folder})
      if (inner.filename() == name && fs::exists(inner.parent_path() / summary_file))
        throw EnvironmentError(fmt::format("{} lies in {}, where another run has its own files: choose another folder with --out",
                                           folder.string(), inner.string()));
}

/// The newest checkpoint of a run that has not ended normally.
std::optional<fs::path> could_go_on(const fs::path& folder)
{
  std::error_code not_there;
  fs::path newest;
  for (const auto& entry : fs::directory_iterator(folder / checkpoint_folder, not_there))
    if (is_numbered(entry.path().filename().string(), "step_", ".h5"))
      newest = std::max(newest, entry.path());
  if (newest.empty())
    return std::nullopt;
  try {
    if (read_summary(folder / summary_file).status == "done")
      return std::nullopt;
  } catch (const EnvironmentError&) {  // how it ended is unknown
  }
  return newest;
}

bool is_scene_of(const fs::path& folder, const Replacing& how)
{
  std::error_code not_there;
  return how.scene && fs::equivalent(*how.scene, folder / scene_file, not_there);
}

/// Names of results, relative to the folder, under which there are files that the list does not prove to be files of a run.
std::vector<std::string> foreign_files(const fs::path& folder, const Manifest& manifest, bool keeps_scene)
{
  std::vector<std::string> foreign;
  const auto look_at = [&](const fs::path& within) {
    std::error_code not_there;
    for (const auto& entry : fs::directory_iterator(folder / within, not_there))
      if (const std::string name = (within / entry.path().filename()).string();
          is_written_by_runs(name) && !(keeps_scene && name == scene_file) && !manifest.proves(name))
        foreign.push_back(name);
  };
  look_at("");
  for (const char* name : folders_of_runs) {
    if (fs::exists(folder / name) && !fs::is_directory(folder / name))
      foreign.emplace_back(name);
    look_at(name);
  }
  std::sort(foreign.begin(), foreign.end());
  return foreign;
}

/// All checks of check_replaceable() for an existing folder.
void examine(const fs::path& folder, const Replacing& how)
{
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw EnvironmentError(fmt::format("{} cannot be written: {}", folder.string(), std::strerror(errno)));
  const auto manifest = Manifest::of(folder);
  if (!manifest && !holds_nothing(folder))
    throw EnvironmentError(
        fs::exists(folder / summary_file)
            ? fmt::format(
                  "{} holds a summary.json but no list of what a run wrote there ({}/files.txt), by which files of a run are told from "
                  "yours: choose another folder with --out, or move this one away",
                  folder.string(), own_folder)
            : fmt::format("{} is not empty and holds no results of an earlier run (no summary.json): choose another folder with --out",
                          folder.string()));
  if (!manifest)
    return;
  if (const auto checkpoint = could_go_on(folder); checkpoint && !how.force)
    throw EnvironmentError(
        fmt::format("{} holds a run that did not come to its end and can go on from {}: talus run --resume {}; to throw "
                    "it away, --force",
                    folder.string(), checkpoint->filename().string(), shell_word(folder)));
  if (auto foreign = foreign_files(folder, *manifest, is_scene_of(folder, how)); !foreign.empty()) {
    constexpr std::size_t most = 5;
    const std::size_t n = foreign.size();
    foreign.resize(std::min(n, most));
    throw EnvironmentError(
        fmt::format("{} holds {}{}, which no run wrote or which changed since: a run would replace {}. Move {} away, or "
                    "choose another folder with --out",
                    folder.string(), fmt::join(foreign, ", "), n > most ? fmt::format(" and {} more", n - most) : "",
                    n == 1 ? "it" : "them", n == 1 ? "it" : "them"));
  }
}

/// Calls f(); errors of the file system become EnvironmentError with `what`, file and reason.
template <class F>
auto naming(const std::string& what, F&& f)
try {
  return f();
} catch (const fs::filesystem_error& e) {
  throw EnvironmentError(fmt::format("{}: {}", what, e.code().message()));
}

}  // namespace

void check_replaceable(const fs::path& folder, const Replacing& how)
{
  naming(folder.string() + " cannot be made", [&] {
    check_place(folder);
    if (!fs::exists(folder))
      return;
    if (!fs::is_directory(folder))
      throw fs::filesystem_error("", folder, std::make_error_code(std::errc::not_a_directory));
    const FolderLock nobody_else(folder);
    examine(folder, how);
  });
}

std::uintmax_t bytes_replaced(const fs::path& folder)
{
  std::uintmax_t bytes = 0;
  if (const auto manifest = Manifest::of(folder))
    for (const std::string& name : manifest->names()) {
      std::error_code not_there;
      const std::uintmax_t size = fs::file_size(folder / name, not_there);
      if (!not_there && manifest->proves(name))
        bytes += size;
    }
  return bytes;
}

NewResults::NewResults(fs::path folder, Replacing how) : folder_(std::move(folder)), staging_(folder_ / own_folder / "new")
{
  naming(folder_.string() + " cannot be made", [&] {
    check_place(folder_);
    made_ = fs::create_directories(folder_);
    lock_ = FolderLock(folder_);
    examine(folder_, how);
    keeps_scene_ = is_scene_of(folder_, how);
    fs::remove_all(staging_);
  });
  try {
    begin_manifest(staging_);
  } catch (const EnvironmentError&) {
    leave_as_it_was();
    throw;
  }
}

NewResults::~NewResults()
{
  if (!done_)
    leave_as_it_was();
}

void NewResults::leave_as_it_was() const noexcept
{
  try {
    std::error_code stays;
    fs::remove_all(staging_, stays);
    fs::remove(folder_ / own_folder, stays);  // unless it contains a list
    if (made_)
      fs::remove(folder_, stays);
  } catch (const std::bad_alloc&) {  // the first error is reported; the next run removes the rest
  }
}

FolderLock NewResults::commit()
{
  const auto old = Manifest::of(folder_);
  const Manifest fresh = Manifest::of(staging_).value();
  const auto names = fresh.names();
  std::vector<std::string> gone;
  for (const std::string& name : old ? old->names() : std::vector<std::string>())
    if (std::find(names.begin(), names.end(), name) == names.end() && !(keeps_scene_ && name == scene_file) && old->proves(name))
      gone.push_back(name);
  const std::string scene_lines = keeps_scene_ && old && old->proves(scene_file) ? old->lines_of(scene_file) : "";
  naming("the results in " + folder_.string() + " cannot be replaced", [&] {
    // The list always contains all files: a run that is killed here leaves no unlisted file.
    replace_manifest(folder_, (old ? old->text() : "") + fresh.text());
    const auto put = [&](const std::string& name) {
      set_aside_unless_proved(folder_ / name);
      fs::rename(staging_ / name, folder_ / name);
    };
    put(summary_file);  // from here on the folder belongs to the new run, which has not ended
    for (const std::string& name : names)
      if (name != summary_file)
        put(name);
    for (const std::string& name : gone)
      fs::remove(folder_ / name);
    remove_leftovers(folder_);
    std::error_code not_empty;
    for (const std::string_view name : {checkpoint_folder, map_folder, section_folder, picture_folder})
      if (fs::is_directory(fs::symlink_status(folder_ / name, not_empty)))
        fs::remove(folder_ / name, not_empty);
    replace_manifest(folder_, scene_lines + fresh.text());
  });
  done_ = true;
  return std::move(lock_);
}

void adopt_results(const fs::path& folder)
{
  if (Manifest::of(folder))
    return;
  begin_manifest(folder);
  const auto adopt = [&](const fs::path& within) {
    std::error_code not_there;
    for (const auto& entry : fs::directory_iterator(folder / within, not_there))
      if (const std::string name = (within / entry.path().filename()).string();
          is_written_by_runs(name) && name != scene_file && fs::is_regular_file(fs::symlink_status(entry.path(), not_there)))
        note_result(entry.path(), entry.path());
  };
  adopt("");
  for (const char* name : folders_of_runs)
    adopt(name);
}

}  // namespace talus
