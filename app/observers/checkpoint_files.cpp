#include "app/observers/checkpoint_files.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/observers/checkpoints.hpp"
#include "app/observers/results.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/manifest.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

constexpr auto prefix = "step_", suffix = ".h5";

bool is_checkpoint(const fs::path& file) { return is_numbered(file.filename().string(), prefix, suffix); }

/// Names have equal lengths up to a billion steps; longer ones are newer.
bool is_newer(const fs::path& a, const fs::path& b)
{
  const std::string x = a.filename().string(), y = b.filename().string();
  return std::pair(x.size(), x) > std::pair(y.size(), y);
}

}  // namespace

std::string name_of_checkpoint(std::int64_t step) { return fmt::format("{}{:09}{}", prefix, step, suffix); }

std::vector<fs::path> checkpoints_in(const fs::path& folder)
{
  std::vector<fs::path> files;
  std::error_code trouble;
  for (const auto& entry : fs::directory_iterator(folder, trouble))
    if (is_checkpoint(entry.path()))
      files.push_back(entry.path());
  if (trouble && trouble != std::errc::no_such_file_or_directory)
    throw EnvironmentError(fmt::format("{} cannot be read: {}", folder.string(), trouble.message()));
  std::sort(files.begin(), files.end(), is_newer);
  return files;
}

std::vector<fs::path> set_aside_newer(const fs::path& folder, const fs::path& taken)
{
  std::vector<fs::path> aside;
  const auto manifest = Manifest::of(folder);
  for (const fs::path& file : checkpoints_in(folder / checkpoint_folder))
    if (is_newer(file, taken)) {
      aside.push_back(name_aside(file));
      if (manifest && manifest->proves((fs::path(checkpoint_folder) / file.filename()).string()))
        note_result(aside.back(), file);
      std::error_code stays;
      fs::rename(file, aside.back(), stays);
      if (stays)
        throw EnvironmentError(fmt::format("{} cannot be renamed: {}", file.string(), stays.message()));
    }
  return aside;
}

}  // namespace talus
