#include "app/observers/results.hpp"

#include <fmt/format.h>
#include <sys/file.h>

#include <cerrno>
#include <chrono>
#include <thread>

#include "core/error.hpp"
#include "io/files/manifest.hpp"

namespace talus {

namespace fs = std::filesystem;

namespace {

/// Whether another process has the lock.
bool is_taken(int handle, int kind) { return ::flock(handle, kind | LOCK_NB) != 0 && errno == EWOULDBLOCK; }

}  // namespace

FolderLock::FolderLock(const fs::path& folder) : handle_(folder, O_RDONLY | O_DIRECTORY)
{
  bool taken = handle_.is_open() && is_taken(handle_.number(), LOCK_EX);
  for (int again = 0; taken && again < 10; ++again) {  // a process that checks for a run holds the lock for a moment
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    taken = is_taken(handle_.number(), LOCK_EX);
  }
  if (taken)
    throw EnvironmentError(
        fmt::format("another run is writing its results to {}: wait for its end, or choose another folder with --out", folder.string()));
}

bool run_is_at_work(const fs::path& folder)
{
  const FileDescriptor opened(folder, O_RDONLY | O_DIRECTORY);
  return opened.is_open() && is_taken(opened.number(), LOCK_SH);
}

void remove_leftovers(const fs::path& folder)
{
  std::error_code not_there;
  for (const fs::path& name : {fs::path(), fs::path(checkpoint_folder), fs::path(map_folder), fs::path(section_folder)})
    for (const auto& entry : fs::directory_iterator(folder / name, not_there))
      if (const fs::path file = entry.path(); file.extension() == ".tmp" && is_written_by_runs((name / file.stem()).string()))
        fs::remove(file, not_there);
  fs::remove_all(folder / own_folder / "new", not_there);
}

bool lies_in(const fs::path& source, const fs::path& folder)
{
  const fs::path cleared = fs::weakly_canonical(folder);
  fs::path place = fs::weakly_canonical(source).parent_path();
  while (place != cleared && place != place.parent_path())
    place = place.parent_path();
  return place == cleared;
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
