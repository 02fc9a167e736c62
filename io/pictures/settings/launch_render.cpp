// Starts talus-render and parses its output.
#include "io/pictures/settings/launch_render.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string_view>

#include "core/error.hpp"
#include "io/system/child_process.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

// Prefixes with which talus-render announces a file and lines about it; xvfb-run may merge its two outputs.
constexpr std::string_view file_mark = "file: ", said_mark = "said: ";
constexpr int refused = 2;  // exit code of talus-render for arguments that do not fit the results

bool has_display()
{
  const char* display = std::getenv("DISPLAY");
  return display != nullptr && *display != '\0';
}

std::vector<std::string> command_line(const fs::path& talus_render, const std::vector<std::string>& arguments, Display display)
{
  if (::access(talus_render.c_str(), X_OK) != 0)
    throw EnvironmentError(fmt::format("cannot start {}: {}", talus_render.string(), std::strerror(errno)));
  std::vector<std::string> words;
  if (display == Display::needed && !has_display()) {
    for (const char* program : {"xvfb-run", "Xvfb", "xauth"})
      if (!on_path(program))
        throw EnvironmentError(
            fmt::format("pictures need a display, and without one the program {}, which is missing: install the packages xvfb and xauth "
                        "(Debian: apt-get install xvfb xauth libgl1-mesa-dri)",
                        program));
    words = {"xvfb-run", "-a"};
  }
  words.push_back(talus_render.string());
  words.insert(words.end(), arguments.begin(), arguments.end());
  return words;
}

/// Throws the error of a failed talus-render.  An abort appears as a signal, or as 128 + its number if a shell (xvfb-run) started it.
[[noreturn]] void explain(const fs::path& talus_render, int code, const std::string& messages)
{
  if (code == refused)
    throw Error(messages);
  if (code > Ending::of_signal)
    throw EnvironmentError(fmt::format("{} was ended by signal {}. {}\n{}", talus_render.string(), code - Ending::of_signal,
                                       has_display()
                                           ? "DISPLAY is set; without it, xvfb-run draws in memory: try env -u DISPLAY talus render ..."
                                           : "Is software OpenGL there (Debian: libgl1-mesa-dri)?",
                                       messages));
  throw EnvironmentError(fmt::format("{} failed (exit code {}): {}", talus_render.string(), code, messages));
}

}  // namespace

std::vector<RenderedFile> launch_render(const fs::path& talus_render, const std::vector<std::string>& arguments, Display display)
{
  const Ending ending = run_to_its_end(command_line(talus_render, arguments, display));
  std::vector<RenderedFile> files;
  std::string messages;
  std::istringstream lines(ending.output);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(file_mark))
      files.push_back({line.substr(file_mark.size()), {}});
    else if (line.starts_with(said_mark) && !files.empty())
      files.back().said.push_back(line.substr(said_mark.size()));
    else
      messages += (messages.empty() ? "" : "\n") + line;
  }
  if (ending.code != 0)
    explain(talus_render, ending.code, messages);
  if (!messages.empty())
    fmt::print(stderr, "{}\n", messages);
  if (files.empty())
    throw EnvironmentError(fmt::format("{} wrote nothing", talus_render.string()));
  for (const RenderedFile& file : files) {
    std::error_code failed;
    if (fs::file_size(file.path, failed) == 0 || failed)
      throw EnvironmentError(fmt::format("{} says it wrote {}, which is not there", talus_render.string(), file.path.string()));
  }
  return files;
}

std::vector<RenderedFile> launch_render(const std::vector<std::string>& arguments, Display display)
{
  return launch_render(fs::read_symlink("/proc/self/exe").parent_path() / "talus-render", arguments, display);
}

}  // namespace talus
