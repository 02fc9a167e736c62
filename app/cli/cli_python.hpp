#pragma once
// Options that are passed on to a command of the Python package, after they have been checked here.
#include <CLI/CLI.hpp>

#include <string>
#include <vector>

#include "app/commands/package_command.hpp"

namespace talus {

/// Adds files and options to a command of the package.  An option that is given becomes a word such as "--width=0.02", a file the word that it
/// is.  Both commands outlive this object, and the parse.
class OptionsOfPython {
 public:
  OptionsOfPython(CLI::App& app, PackageCommand& command) : app_(app), words_(command.words) {}

  CLI::Option* add_file(const std::string& name, const std::string& help) const
  {
    return app_
        .add_option_function<std::string>(
            name, [&words = words_](const std::string& value) { words.push_back(value); }, help)
        ->required();
  }
  CLI::Option* add(const std::string& name, const std::string& help) const
  {
    return app_.add_option_function<std::string>(
        name, [&words = words_, name](const std::string& value) { words.push_back(name + '=' + value); }, help);
  }
  /// An option with several values, each of which becomes a word.
  CLI::Option* add_list(const std::string& name, const std::string& help) const
  {
    return app_.add_option_function<std::vector<std::string>>(
        name,
        [&words = words_, name](const std::vector<std::string>& values) {
          for (const std::string& value : values)
            words.push_back(name + '=' + value);
        },
        help);
  }
  CLI::Option* add_flag(const std::string& name, const std::string& help) const
  {
    return app_.add_flag_callback(
        name, [&words = words_, name] { words.push_back(name); }, help);
  }

 private:
  CLI::App& app_;
  std::vector<std::string>& words_;
};

}  // namespace talus
