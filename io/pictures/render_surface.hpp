#pragma once
// Surfaces of bodies as files for other programs.
#include <filesystem>
#include <functional>
#include <string>

#include "io/pictures/settings/picture_settings.hpp"

namespace talus::render {

/// Writes the surfaces and calls `written` with every file that is on the disk, and a line with the enclosed volume of each body.  Needs no
/// display.  Throws Error if the run does not have a requested item or a grid would be too large, EnvironmentError for files.
void make_surfaces(const SurfaceSettings& settings,
                   const std::function<void(const std::filesystem::path& file, const std::string& said)>& written);

}  // namespace talus::render
