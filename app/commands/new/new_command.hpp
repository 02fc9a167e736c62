#pragma once
// A scene from a template and answers.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace talus {

struct NewOptions {
  std::optional<std::string> from;  ///< name of a template, or its file
  std::optional<std::filesystem::path> out;
  std::vector<std::string> set;  ///< name=value of questions; then nothing is asked
  bool list = false, force = false;
};
/// Writes a scene from a template and answers.  SceneErrors, Error: an answer or the template is wrong; the file is there already.
void new_scene(const NewOptions& options);

}  // namespace talus
