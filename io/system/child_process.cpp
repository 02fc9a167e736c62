// fork and exec.
#include "io/system/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <utility>

#include "core/error.hpp"
#include "io/files/file_descriptor.hpp"

namespace talus {

namespace {

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

/// Starts a program whose output goes to a descriptor.
pid_t start(std::vector<std::string>& words, int output)
{
  std::vector<char*> argv;
  for (std::string& word : words)
    argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t id = ::fork();
  if (id == 0) {  // only calls that are safe after fork in a program with threads
    ::dup2(output, STDOUT_FILENO);
    ::dup2(output, STDERR_FILENO);
    ::execvp(argv.front(), argv.data());
    ::_exit(Ending::not_started);
  }
  if (id < 0)
    throw EnvironmentError(fmt::format("cannot start {}: {}", words.front(), std::strerror(errno)));
  return id;
}

int wait_for(pid_t id)
{
  int status = 0;
  while (::waitpid(id, &status, 0) != id)
    if (errno != EINTR)
      return Ending::not_started;
  return WIFEXITED(status) ? WEXITSTATUS(status) : Ending::of_signal + WTERMSIG(status);
}

}  // namespace

Ending run_to_its_end(std::vector<std::string> words)
{
  std::array<int, 2> ends;
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw EnvironmentError(fmt::format("cannot start {}: {}", words.front(), std::strerror(errno)));
  FileDescriptor from(ends[0]), to(ends[1]);
  const pid_t child = start(words, to.number());
  to = {};  // closed, so that the end of the child's output can be seen
  std::string output = read_all(from.number());
  return {std::move(output), wait_for(child)};
}

bool on_path(const std::string& program)
{
  const char* variable = std::getenv("PATH");
  std::istringstream folders(variable != nullptr ? variable : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (::access((std::filesystem::path(folder) / program).c_str(), X_OK) == 0)
      return true;
  return false;
}

}  // namespace talus
