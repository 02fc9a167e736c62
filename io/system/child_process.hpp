#pragma once
// Programs that this one starts.
#include <string>
#include <vector>

namespace talus {

/// The end of a program.
struct Ending {
  std::string output;  ///< of both its streams
  int code;            ///< exit code, or 128 + the number of the signal that ended it
  static constexpr int not_started = 127, of_signal = 128;
};
/// words: program, looked for on the path unless it is a path, and its arguments.  Throws EnvironmentError if no process can be started.  A
/// missing program ends with `not_started`.
Ending run_to_its_end(std::vector<std::string> words);

/// Whether one of the folders of PATH contains that program.
bool on_path(const std::string& program);

}  // namespace talus
