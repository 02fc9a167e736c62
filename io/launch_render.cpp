// One pipe for standard output and standard error of the program.
#include "io/launch_render.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <sstream>
#include <string_view>

#include "core/error.hpp"
#include "io/child_process.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view picture_mark = "picture: ";  // how talus-render announces a file; xvfb-run may merge its two outputs
constexpr int refused = 2;                              // its exit code for arguments that do not fit the results

bool on_path(const std::string& program)
{
  const char* variable = std::getenv("PATH");
  std::istringstream folders(variable != nullptr ? variable : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (::access((fs::path(folder) / program).c_str(), X_OK) == 0)
      return true;
  return false;
}

bool has_display()
{
  const char* display = std::getenv("DISPLAY");
  return display != nullptr && *display != '\0';
}

std::vector<std::string> command_line(const fs::path& talus_render, const std::vector<std::string>& arguments)
{
  if (::access(talus_render.c_str(), X_OK) != 0)
    throw EnvironmentError(fmt::format("cannot start {}: {}", talus_render.string(), std::strerror(errno)));
  std::vector<std::string> words;
  if (!has_display()) {
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

struct Ending {
  std::string output;
  int code;  ///< as ChildProcess gives it
};

std::string read_all(int descriptor)
{
  std::string text;
  std::array<char, 4096> block;
  for (;;) {
    const ssize_t got = ::read(descriptor, block.data(), block.size());
    if (got > 0)
      text.append(block.data(), static_cast<std::size_t>(got));
    else if (got == 0 || errno != EINTR)
      return text;
  }
}

Ending run(std::vector<std::string> words)
{
  std::array<int, 2> ends;
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw EnvironmentError(fmt::format("cannot start {}: {}", words.front(), std::strerror(errno)));
  std::optional<ChildProcess> child;
  try {
    child.emplace(std::move(words), ends[1]);
  } catch (const EnvironmentError&) {
    ::close(ends[0]), ::close(ends[1]);
    throw;
  }
  ::close(ends[1]);
  Ending ending{read_all(ends[0]), 0};
  ::close(ends[0]);
  ending.code = child->wait();
  return ending;
}

/// An abort shows as a signal, or as 128 + its number when a shell (xvfb-run) stands between.
[[noreturn]] void explain(const fs::path& talus_render, int code, const std::string& messages)
{
  if (code == refused)
    throw Error(messages);
  if (code > ChildProcess::of_signal)
    throw EnvironmentError(fmt::format("{} was ended by signal {}. {}\n{}", talus_render.string(), code - ChildProcess::of_signal,
                                       has_display()
                                           ? "DISPLAY is set; without it, xvfb-run draws in memory: try env -u DISPLAY talus render ..."
                                           : "Is software OpenGL there (Debian: libgl1-mesa-dri)?",
                                       messages));
  throw EnvironmentError(fmt::format("{} failed (exit code {}): {}", talus_render.string(), code, messages));
}

}  // namespace

std::vector<fs::path> launch_render(const fs::path& talus_render, const std::vector<std::string>& arguments)
{
  const Ending ending = run(command_line(talus_render, arguments));
  std::vector<fs::path> pictures;
  std::string messages;
  std::istringstream lines(ending.output);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(picture_mark))
      pictures.emplace_back(line.substr(picture_mark.size()));
    else
      messages += (messages.empty() ? "" : "\n") + line;
  }
  if (ending.code != 0)
    explain(talus_render, ending.code, messages);
  if (!messages.empty())
    fmt::print(stderr, "{}\n", messages);
  if (pictures.empty())
    throw EnvironmentError(fmt::format("{} wrote no picture", talus_render.string()));
  for (const fs::path& picture : pictures) {
    std::error_code failed;
    if (fs::file_size(picture, failed) == 0 || failed)
      throw EnvironmentError(fmt::format("{} says it wrote {}, which is not there", talus_render.string(), picture.string()));
  }
  return pictures;
}

}  // namespace talus
