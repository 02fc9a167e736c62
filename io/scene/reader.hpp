#pragma once
// Reading a scene file, strictly: everything that is wrong is found at once, with file, line, column and key.
#include <algorithm>
#include <filesystem>
#include <span>
#include <string>

#include "io/scene/point_test.hpp"
#include "io/scene/scene.hpp"
#include "io/scene/study.hpp"

namespace talus {

/// The scene in a YAML file, changed by overrides such as "time.end=2" or "bodies[0].particles_per_cell=6" (from --set).
///
/// When it returns, every rule is kept that does not need the mesh.  Otherwise it throws SceneErrors with all that is wrong, sorted
/// by place; the file of a problem in an override is its text, such as `--set time.end=2x`.  A subset of YAML is read: no anchors,
/// aliases, merge keys or tags, one document, decimal numbers, `true` and `false`.
Scene read_scene(const std::filesystem::path& file, std::span<const std::string> overrides = {});
/// The same of a text that was in `file`.
Scene read_scene_text(const std::filesystem::path& file, const std::string& text, std::span<const std::string> overrides = {});

/// Which keys of a mapping are taken.
struct KeyChoice {
  std::span<const std::string_view> only = {};     ///< none: all
  std::span<const std::string_view> without = {};  ///< but these
  bool takes(std::string_view key) const noexcept
  {
    const auto names = [&](std::span<const std::string_view> list) { return std::find(list.begin(), list.end(), key) != list.end(); };
    return (only.empty() || names(only)) && !names(without);
  }
};
/// What stands at a path of keys, in one line as an override takes it, with the chosen keys of that mapping.  Empty where nothing stands.
std::string written_in_scene(const std::filesystem::path& file, std::span<const std::string> overrides, std::string_view path,
                             const KeyChoice& keys = {});

/// The text of a scene with the values of overrides in the places of its own; comments stay.  SceneErrors: the text has no such key, or its
/// value stands on several lines.
std::string with_values(const std::filesystem::path& file, std::string text, std::span<const std::string> overrides);

/// The file of `talus drive`, read in the same way.
PointTest read_point_path(const std::filesystem::path& file, std::span<const std::string> overrides = {});

/// The file of `talus sweep`.  That each case is a sound scene is seen when its scene is read with the changes.
Study read_study(const std::filesystem::path& file);

}  // namespace talus
