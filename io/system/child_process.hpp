#pragma once
// Another program beside this one.
#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace talus {

/// A program that was started and runs on its own.  Who lets go of it without having seen its end has it told to end, and waits.
class ChildProcess {
 public:
  /// words: program, looked for on the path unless it is one, and its arguments.  Standard output and error go to the descriptor `output`.
  /// EnvironmentError: there is no room for another process.  A program that is not there ends with `not_started`.
  ChildProcess(std::vector<std::string> words, int output);
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&& other) noexcept;

  /// Its exit code, or 128 + the number of the signal that ended it.
  int wait();
  /// The same, or nothing while it runs.
  std::optional<int> ended();
  /// SIGTERM: a run that gets it writes a checkpoint and ends.
  void ask_to_end() const noexcept;

  static constexpr int not_started = 127, of_signal = 128;

 private:
  pid_t id_ = -1;
  std::optional<int> code_;
};

/// What a program said on both its outputs, and how it ended: as ChildProcess::wait().
struct Ending {
  std::string output;
  int code;
};
Ending run_to_its_end(std::vector<std::string> words);

/// Whether one of the folders of PATH has that program.
bool on_path(const std::string& program);

}  // namespace talus
