#pragma once
// Python in place of this process, for commands that are written in it.
#include <string>
#include <vector>

namespace talus {

/// Replaces this process by Python with these words; Debian's Python, which has Debian's modules, is preferred to others on the path.
/// It writes no files beside installed scripts.  Throws EnvironmentError where it cannot be started.
[[noreturn]] void become_python(const std::vector<std::string>& words);

}  // namespace talus
