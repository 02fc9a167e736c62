#pragma once
// A program started by this one.
#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace talus {

/// A running child process.  If it is destroyed before the end of the process was seen, it asks the process to end, and waits.
class ChildProcess {
 public:
  /// words: program, looked for on the path unless it is a path, and its arguments.  Standard output and error go to the descriptor
  /// `output`.  Throws EnvironmentError if no process can be started.  A missing program ends with `not_started`.
  ChildProcess(std::vector<std::string> words, int output);
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&& other) noexcept;

  /// Waits; returns the exit code, or 128 + the number of the signal that ended it.
  int wait();
  /// As wait(), but returns nothing while it runs.
  std::optional<int> ended();
  /// Sends SIGTERM; a run then writes a checkpoint and ends.
  void ask_to_end() const noexcept;

  static constexpr int not_started = 127, of_signal = 128;

 private:
  pid_t id_ = -1;
  std::optional<int> code_;
};

/// The output of a program on both its streams, and its exit code as in ChildProcess::wait().
struct Ending {
  std::string output;
  int code;
};
Ending run_to_its_end(std::vector<std::string> words);

/// Whether one of the folders of PATH contains that program.
bool on_path(const std::string& program);

}  // namespace talus
