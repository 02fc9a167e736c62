#include "app/results.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "core/error.hpp"

namespace talus {

namespace fs = std::filesystem;

bool is_numbered(std::string_view name, std::string_view prefix, std::string_view suffix) noexcept
{
  if (!name.starts_with(prefix) || !name.ends_with(suffix) || name.size() <= prefix.size() + suffix.size())
    return false;
  const std::string_view number = name.substr(prefix.size(), name.size() - prefix.size() - suffix.size());
  return std::all_of(number.begin(), number.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

namespace {

/// Whether somebody else has it.
bool is_taken(int handle, int kind) { return ::flock(handle, kind | LOCK_NB) != 0 && errno == EWOULDBLOCK; }

/// Of a folder.
int opened(const fs::path& folder) { return ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); }

}  // namespace

FolderLock::FolderLock(const fs::path& folder) : handle_(opened(folder))
{
  bool taken = handle_ >= 0 && is_taken(handle_, LOCK_EX);
  for (int again = 0; taken && again < 10; ++again) {  // who only looks whether a run is at work has it for a moment
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    taken = is_taken(handle_, LOCK_EX);
  }
  if (taken) {
    ::close(handle_);
    throw EnvironmentError(
        fmt::format("another run is writing its results to {}: wait for its end, or choose another folder with --out", folder.string()));
  }
}

FolderLock::~FolderLock()
{
  if (handle_ >= 0)
    ::close(handle_);
}

bool run_is_at_work(const fs::path& folder)
{
  const int handle = opened(folder);
  const bool taken = handle >= 0 && is_taken(handle, LOCK_SH);
  if (handle >= 0)
    ::close(handle);
  return taken;
}

namespace {

/// Files that a run writes, and the pictures drawn of them.
bool is_result(const fs::path& file)
{
  static constexpr std::array<std::string_view, 11> names{"summary.json", "history.csv", "runout.csv", "particles.pvd",
                                                          "mesh.pvd",     "mesh.msh",    "mesh.vtu",   "scene.yaml",
                                                          initial_file,   progress_file, report_file};
  const std::string name = file.filename().string();
  for (const std::string_view known : names)
    if (name == known)
      return true;
  return is_numbered(name, "particles_", ".vtp") || is_numbered(name, "mesh_", ".vtu");
}

/// What a run that is killed now leaves behind of the summary it is writing.
bool is_empty_but_for_leftovers(const fs::path& folder)
{
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().filename() != "summary.json.tmp")
      return false;
  return true;
}

}  // namespace

void remove_leftovers(const fs::path& folder)
{
  for (const fs::path& place : {folder, folder / checkpoint_folder}) {
    std::error_code not_there;
    for (const auto& entry : fs::directory_iterator(place, not_there))
      if (const fs::path file = entry.path(); file.extension() == ".tmp" && (is_result(file.stem()) || file.stem().extension() == ".h5"))
        fs::remove(file, not_there);
  }
}

namespace {

/// Whole folders that go when their run is started again.
constexpr std::array<std::string_view, 4> folders_of_results{"pictures", checkpoint_folder, map_folder, section_folder};

/// EnvironmentError: the folder lies in one of those.
void check_place(const fs::path& folder)
{
  for (fs::path inner = fs::weakly_canonical(folder); inner != inner.parent_path(); inner = inner.parent_path())
    if (std::find(folders_of_results.begin(), folders_of_results.end(), inner.filename()) != folders_of_results.end() &&
        fs::exists(inner.parent_path() / "summary.json"))
      throw EnvironmentError(fmt::format("{} lies in {}, which is removed when the run there is repeated: choose another folder with --out",
                                         folder.string(), inner.string()));
}

}  // namespace

bool lies_in(const fs::path& source, const fs::path& folder)
{
  const fs::path cleared = fs::weakly_canonical(folder);
  fs::path place = fs::weakly_canonical(source).parent_path();
  while (place != cleared && place != place.parent_path())
    place = place.parent_path();
  return place == cleared;
}

FolderLock prepare_results(const fs::path& folder)
try {
  check_place(folder);
  fs::create_directories(folder);
  FolderLock lock(folder);
  if (!is_empty_but_for_leftovers(folder) && !fs::exists(folder / "summary.json"))
    throw EnvironmentError(fmt::format(
        "{} is not empty and holds no results of an earlier run (no summary.json): choose another folder with --out", folder.string()));
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw EnvironmentError(fmt::format("{} cannot be written: {}", folder.string(), std::strerror(errno)));
  for (const auto& entry : fs::directory_iterator(folder))
    if (is_result(entry.path()) && entry.path().filename() != "summary.json")
      fs::remove(entry.path());
  remove_leftovers(folder);
  for (const std::string_view name : folders_of_results)
    fs::remove_all(folder / name);
  fs::remove(folder / "summary.json");  // the last: it says whose the rest is
  return lock;
} catch (const fs::filesystem_error& e) {
  throw EnvironmentError(fmt::format("{} cannot be made: {}", folder.string(), e.code().message()));
}

void require_run(const fs::path& folder)
{
  if (std::error_code not_there; !fs::exists(folder / "summary.json", not_there))
    throw Error(fmt::format("{} holds no results of a run (no summary.json)", folder.string()));
}

void require_results(const fs::path& folder)
{
  if (std::error_code not_there; !fs::exists(folder / "summary.json", not_there))
    throw EnvironmentError(fmt::format("{} has gone while the run went on (no summary.json there)", folder.string()));
}

fs::path default_results(const fs::path& scene)
{
  const fs::path folder = fs::absolute(scene).lexically_normal().parent_path().filename();
  return fs::path("runs") / (scene.filename() == "scene.yaml" && !folder.empty() ? folder : scene.stem());
}

}  // namespace talus
