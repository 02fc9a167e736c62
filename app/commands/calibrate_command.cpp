// The command talus calibrate: finds the Python package talus and replaces this process by it.
#include "app/commands/calibrate_command.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "app/commands/python_process.hpp"

namespace talus {

void calibrate(const CalibrateOptions& options)
{
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe");
  std::string path =
      find_scripts(self, {.what = "the Python package talus", .variable = "TALUS_PACKAGE", .file = "talus/__main__.py", .folder = "python"})
          .string();
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
