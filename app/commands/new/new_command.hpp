#pragma once
// Command talus new, and the scenes that it copies.
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
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

/// A file of scenes/templates, with its text when the program was built.
struct TemplateText {
  std::string_view name, text;
};
std::span<const TemplateText> shipped_templates();
std::vector<std::string> template_names();

}  // namespace talus
