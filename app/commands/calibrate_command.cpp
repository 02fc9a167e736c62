// The command talus calibrate: finds the Python package talus and replaces this process by it.
#include "app/commands/calibrate_command.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "app/commands/python_process.hpp"
#include "core/error.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// The folder that contains the Python package talus: given by the environment, installed in PREFIX/share for PREFIX/libexec/talus/talus, or
/// in the sources of build/<preset>/talus.
fs::path package_folder(const fs::path& self)
{
  const fs::path script = "talus/__main__.py";
  if (const char* given = std::getenv("TALUS_PACKAGE"); given != nullptr && *given != '\0') {
    if (!fs::exists(fs::path(given) / script))
      throw EnvironmentError(fmt::format("TALUS_PACKAGE is {}, where there is no {}", given, script.string()));
    return given;
  }
  const fs::path above = self.parent_path().parent_path().parent_path(), installed = above / "share/talus/python",
                 source = above / "python";
  for (const fs::path& folder : {installed, source})
    if (fs::exists(folder / script))
      return folder;
  throw EnvironmentError(
      fmt::format("the Python package talus is neither in {} nor in {}: set TALUS_PACKAGE to the folder python of the sources",
                  installed.string(), source.string()));
}

}  // namespace

void calibrate(const CalibrateOptions& options)
{
  const fs::path self = fs::read_symlink("/proc/self/exe");
  std::string path = package_folder(self).string();
  if (const char* before = std::getenv("PYTHONPATH"); before != nullptr && *before != '\0')
    path += fmt::format(":{}", before);
  ::setenv("PYTHONPATH", path.c_str(), 1);
  std::vector<std::string> words{"-P", "-m", "talus", "calibrate", options.specification.string(), "--program", self.string()};
  if (options.out)
    words.insert(words.end(), {"--out", options.out->string()});
  if (options.jobs)
    words.insert(words.end(), {"--jobs", std::to_string(*options.jobs)});
  if (options.threads)
    words.insert(words.end(), {"--threads", std::to_string(*options.threads)});
  if (!options.pictures)
    words.emplace_back("--no-pictures");
  if (options.quiet)
    words.emplace_back("--quiet");
  become_python(words);
}

}  // namespace talus
