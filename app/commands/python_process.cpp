#include "app/commands/python_process.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "core/error.hpp"

namespace talus {

namespace fs = std::filesystem;

fs::path find_scripts(const fs::path& self, const PythonScripts& scripts)
{
  if (const char* given = std::getenv(scripts.variable.c_str()); given != nullptr && *given != '\0') {
    if (!fs::exists(fs::path(given) / scripts.file))
      throw EnvironmentError(fmt::format("{} is {}, where there is no {}", scripts.variable, given, scripts.file));
    return given;
  }
  const fs::path above = self.parent_path().parent_path().parent_path(), installed = above / "share/talus" / scripts.folder,
                 source = above / scripts.folder;
  for (const fs::path& candidate : {installed, source})
    if (fs::exists(candidate / scripts.file))
      return candidate;
  throw EnvironmentError(fmt::format("{} is neither in {} nor in {}: set {} to the folder {} of the sources", scripts.what,
                                     installed.string(), source.string(), scripts.variable, scripts.folder));
}

void become_command(const std::string& name, const std::vector<std::string>& words)
{
  const fs::path self = fs::read_symlink("/proc/self/exe");
  std::string path =
      find_scripts(self, {.what = "the Python package talus", .variable = "TALUS_PACKAGE", .file = "talus/__main__.py", .folder = "python"})
          .string();
  if (const char* before = std::getenv("PYTHONPATH"); before != nullptr && *before != '\0')
    path += fmt::format(":{}", before);
  ::setenv("PYTHONPATH", path.c_str(), 1);
  std::vector<std::string> all{"-P", "-m", "talus", name, "--program", self.string()};
  all.insert(all.end(), words.begin(), words.end());
  become_python(all);
}

void become_python(const std::vector<std::string>& words)
{
  const std::string python = ::access("/usr/bin/python3", X_OK) == 0 ? "/usr/bin/python3" : "python3";
  std::vector<std::string> all{python, "-B"};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char*> pointers;
  for (std::string& word : all)
    pointers.push_back(word.data());
  pointers.push_back(nullptr);
  std::fflush(nullptr);
  ::execvp(python.c_str(), pointers.data());
  throw EnvironmentError(fmt::format("cannot start {}: {}", python, std::strerror(errno)));
}

}  // namespace talus
