// fork and exec.
#include "io/system/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <utility>

#include "core/error.hpp"
#include "io/files/file_descriptor.hpp"

namespace talus {

namespace {

int code_of(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : ChildProcess::of_signal + WTERMSIG(status); }

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

}  // namespace

ChildProcess::ChildProcess(std::vector<std::string> words, int output)
{
  std::vector<char*> argv;
  for (std::string& word : words)
    argv.push_back(word.data());
  argv.push_back(nullptr);
  id_ = ::fork();
  if (id_ == 0) {  // only calls that are safe after fork in a program with threads
    ::dup2(output, STDOUT_FILENO);
    ::dup2(output, STDERR_FILENO);
    ::execvp(argv.front(), argv.data());
    ::_exit(not_started);
  }
  if (id_ < 0)
    throw EnvironmentError(fmt::format("cannot start {}: {}", words.front(), std::strerror(errno)));
}

ChildProcess::~ChildProcess()
{
  if (id_ > 0 && !code_) {
    ask_to_end();
    wait();
  }
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept : id_(std::exchange(other.id_, -1)), code_(other.code_) {}

ChildProcess& ChildProcess::operator=(ChildProcess&& other) noexcept
{
  std::swap(id_, other.id_);
  std::swap(code_, other.code_);
  return *this;
}

int ChildProcess::wait()
{
  int status = 0;
  while (!code_)
    if (::waitpid(id_, &status, 0) == id_)
      code_ = code_of(status);
    else if (errno != EINTR)
      code_ = not_started;
  return *code_;
}

std::optional<int> ChildProcess::ended()
{
  if (int status = 0; !code_ && ::waitpid(id_, &status, WNOHANG) == id_)
    code_ = code_of(status);
  return code_;
}

void ChildProcess::ask_to_end() const noexcept
{
  if (id_ > 0 && !code_)
    ::kill(id_, SIGTERM);
}

Ending run_to_its_end(std::vector<std::string> words)
{
  std::array<int, 2> ends;
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw EnvironmentError(fmt::format("cannot start {}: {}", words.front(), std::strerror(errno)));
  FileDescriptor from(ends[0]), to(ends[1]);
  ChildProcess child(std::move(words), to.number());
  to = {};  // closed, so that the end of the child's output can be seen
  Ending ending{read_all(from.number()), 0};
  from = {};
  ending.code = child.wait();
  return ending;
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
