#pragma once
// Scripts for shell completion, generated from the description of the command line.
#include <string>
#include <vector>

namespace talus {

/// An option or a positional argument, with the kind of its value: "{a,b}" one of these words, "*.yaml" such files, "FOLDER" a folder.
struct OptionWords {
  std::vector<std::string> names;  ///< for example "--out"; empty for a positional argument
  std::string value;               ///< empty for a flag
  std::string help;
};
struct CommandWords {
  std::string name, help;
  std::vector<OptionWords> options;
};

/// The supported shells: bash, zsh, fish.
std::vector<std::string> completion_shells();

/// The completion script for a shell.
std::string completion_script(const std::string& shell, const std::vector<CommandWords>& commands);

}  // namespace talus
