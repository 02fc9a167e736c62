#pragma once
// Python in place of this process, for commands that are written in it.
#include <filesystem>
#include <string>
#include <vector>

namespace talus {

/// Scripts of the project that a command needs.
struct PythonScripts {
  std::string what;      ///< in words, such as "the verification suite"
  std::string variable;  ///< of the environment, which may name the folder
  std::string file;      ///< that lies in it
  std::string folder;    ///< its name, in the sources of build/<preset>/talus or in PREFIX/share/talus of PREFIX/libexec/talus/talus
};
/// The folder of these scripts for the program at `self`.  Throws EnvironmentError where there is none.
std::filesystem::path find_scripts(const std::filesystem::path& self, const PythonScripts& scripts);

/// Replaces this process by Python with these words; Debian's Python, which has Debian's modules, is preferred to others on the path.
/// It writes no files beside installed scripts.  Throws EnvironmentError where it cannot be started.
[[noreturn]] void become_python(const std::vector<std::string>& words);

/// Replaces this process by a command of the Python package talus: its name, the path of this program, and further words.
/// Throws EnvironmentError where the package or Python is missing.
[[noreturn]] void become_command(const std::string& name, const std::vector<std::string>& words);

}  // namespace talus
