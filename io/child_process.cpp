// fork and exec.
#include "io/child_process.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include "core/error.hpp"

namespace talus {

namespace {

int code_of(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : ChildProcess::of_signal + WTERMSIG(status); }

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

}  // namespace talus
