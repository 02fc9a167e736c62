#pragma once
// The copy of the scene in a results folder, and checks of it when a run is resumed.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/scene/scene.hpp"

namespace talus {

inline constexpr auto scene_copy_file = "scene.yaml";

/// The text of a scene, with the changes by --set as comments at its end.
std::string with_changes(const std::string& text, const std::vector<std::string>& changes);

/// Updates the scene in the folder of a resumed run.  An edited copy is not changed.
void update_scene_copy(const std::filesystem::path& folder, const Scene& scene);

/// Warnings about edits.  A run is resumed with the scene in its checkpoint, `text` with `changes`; later edits of the original file or of
/// the copy in its folder are ignored.
std::vector<std::string> find_edits(const std::filesystem::path& scene_file, const std::optional<std::filesystem::path>& folder,
                                    const std::string& text, const std::vector<std::string>& changes);

}  // namespace talus
