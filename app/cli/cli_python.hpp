#pragma once
// Options that are passed on to a command of the Python package, after they have been checked here.
#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace talus {

/// Adds options to a command; each that is given becomes a word such as "--width=0.02".  Command and words outlive this object, and the parse.
class OptionsOfPython {
 public:
  OptionsOfPython(CLI::App& command, std::vector<std::string>& words) : command_(command), words_(words) {}

  CLI::Option* add(const std::string& name, const std::string& help) const
  {
    return command_.add_option_function<std::string>(
        name, [&words = words_, name](const std::string& value) { words.push_back(name + '=' + value); }, help);
  }
  /// An option with several values, each of which becomes a word.
  CLI::Option* add_list(const std::string& name, const std::string& help) const
  {
    return command_.add_option_function<std::vector<std::string>>(
        name,
        [&words = words_, name](const std::vector<std::string>& values) {
          for (const std::string& value : values)
            words.push_back(name + '=' + value);
        },
        help);
  }
  void add_flag(const std::string& name, const std::string& help) const
  {
    command_.add_flag_callback(
        name, [&words = words_, name] { words.push_back(name); }, help);
  }

 private:
  CLI::App& command_;
  std::vector<std::string>& words_;
};

}  // namespace talus
