#pragma once
// Strict reading of a scene file: all errors are found at once, with file, line, column and key.
#include <filesystem>
#include <span>
#include <string>

#include "io/scene/point_test.hpp"
#include "io/scene/scene.hpp"

namespace talus {

/// Whether the libraries of laws are opened.  A scene that is only looked at, such as that of results, needs no library, and runs no code.
enum class Libraries : std::uint8_t { opened, closed };

/// The scene in a YAML file, changed by overrides such as "time.end=2" or "bodies[0].particles_per_cell=6" (from --set).  The result
/// satisfies all rules that do not need the mesh.  Otherwise throws SceneErrors with all errors, sorted by position; the file of an error
/// in an override is its text, such as `--set time.end=2x`.  A subset of YAML is read: no anchors, aliases, merge keys or tags, one
/// document, decimal numbers, `true` and `false`.
Scene read_scene(const std::filesystem::path& file, std::span<const std::string> overrides = {}, Libraries libraries = Libraries::opened);
/// The scene in a text that was read from `file`.
Scene read_scene_text(const std::filesystem::path& file, const std::string& text, std::span<const std::string> overrides = {},
                      Libraries libraries = Libraries::opened);

/// All keys of a scene with their changes, as JSON.  Throws SceneErrors if it is no YAML.
std::string keys_as_json(const std::filesystem::path& file, std::span<const std::string> overrides);

/// The text of a scene with values replaced by overrides; comments stay.  Throws SceneErrors if the text does not contain the key, or if
/// its value takes several lines.
std::string with_values(const std::filesystem::path& file, std::string text, std::span<const std::string> overrides);

/// The file of `talus drive`, read in the same way.
PointTest read_point_path(const std::filesystem::path& file, std::span<const std::string> overrides = {});

}  // namespace talus
