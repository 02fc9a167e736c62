#pragma once
// Command talus new.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace talus {

struct NewOptions {
  std::optional<std::string> from;  ///< name of a template, or the file of a scene
  std::optional<std::filesystem::path> out;
  std::vector<std::string> set;  ///< key=value, as for `talus run`
  bool list = false, force = false;
};
/// Copies a scene with its comments.  Throws SceneErrors for invalid values, Error if the file exists.
void new_scene(const NewOptions& options);

}  // namespace talus
