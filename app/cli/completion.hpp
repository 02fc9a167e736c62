#pragma once
// What a shell completes after `talus`, out of the command line's own description.
#include <string>
#include <vector>

namespace talus {

/// An option, or a word in its place.  What its value may be: "{a,b}" one of these words, "*.yaml" such files, "FOLDER" a folder.
struct OptionWords {
  std::vector<std::string> names;  ///< "--out"; of a word in its place none
  std::string value;               ///< of a flag empty
  std::string help;
};
struct CommandWords {
  std::string name, help;
  std::vector<OptionWords> options;
};

/// bash, zsh, fish
std::vector<std::string> completion_shells();

/// The script that a shell reads.
std::string completion_script(const std::string& shell, const std::vector<CommandWords>& commands);

}  // namespace talus
