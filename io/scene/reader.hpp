#pragma once
// Strict reading of a scene file: all errors are found at once, with file, line, column and key.
#include <algorithm>
#include <filesystem>
#include <span>
#include <string>

#include "io/scene/point_test.hpp"
#include "io/scene/scene.hpp"

namespace talus {

/// The scene in a YAML file, changed by overrides such as "time.end=2" or "bodies[0].particles_per_cell=6" (from --set).  The result
/// satisfies all rules that do not need the mesh.  Otherwise throws SceneErrors with all errors, sorted by position; the file of an error
/// in an override is its text, such as `--set time.end=2x`.  A subset of YAML is read: no anchors, aliases, merge keys or tags, one
/// document, decimal numbers, `true` and `false`.
Scene read_scene(const std::filesystem::path& file, std::span<const std::string> overrides = {});
/// The scene in a text that was read from `file`.
Scene read_scene_text(const std::filesystem::path& file, const std::string& text, std::span<const std::string> overrides = {});

/// A selection of keys of a mapping.
struct KeyChoice {
  std::span<const std::string_view> only = {};     ///< if empty, all keys
  std::span<const std::string_view> without = {};  ///< without these keys
  bool takes(std::string_view key) const noexcept
  {
    const auto names = [&](std::span<const std::string_view> list) { return std::find(list.begin(), list.end(), key) != list.end(); };
    return (only.empty() || names(only)) && !names(without);
  }
};
/// The value at a path of keys, on one line as an override takes it, with the selected keys of that mapping.  Empty if there is no value.
std::string written_in_scene(const std::filesystem::path& file, std::span<const std::string> overrides, std::string_view path,
                             const KeyChoice& keys = {});

/// The text of a scene with values replaced by overrides; comments stay.  Throws SceneErrors if the text does not contain the key, or if
/// its value takes several lines.
std::string with_values(const std::filesystem::path& file, std::string text, std::span<const std::string> overrides);

/// The file of `talus drive`, read in the same way.
PointTest read_point_path(const std::filesystem::path& file, std::span<const std::string> overrides = {});

}  // namespace talus
