#pragma once
// The scene that a run leaves in its folder, and what has become of it when the run goes on.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/scene/scene.hpp"

namespace talus {

inline constexpr auto scene_copy_file = "scene.yaml";

/// A scene as it was read, and what --set changed of it, in comments at its end.
std::string with_changes(const std::string& text, const std::vector<std::string>& changes);

/// Brings the scene in the folder of a run that goes on up to date.  One that was edited stays as it is.
void update_scene_copy(const std::filesystem::path& folder, const Scene& scene);

/// Warnings: a run goes on with the scene that it began with, which its checkpoint holds as `text` with `changes`.  What has been edited since, in
/// the file it was read from or in the copy in its folder, is not taken.
std::vector<std::string> find_edits(const std::filesystem::path& scene_file, const std::optional<std::filesystem::path>& folder,
                                    const std::string& text, const std::vector<std::string>& changes);

}  // namespace talus
