#pragma once
// Surfaces of bodies as files for other programs.
#include <filesystem>
#include <functional>
#include <string>

#include "io/pictures/settings/picture_settings.hpp"

namespace talus::render {

/// Writes the surfaces and calls `written` with every file once it is on the disk, and a line that says how much of each body it encloses.
/// Needs no display.  Error if the run does not have what is asked for, or a grid would be too large; EnvironmentError for files.
void make_surfaces(const SurfaceSettings& settings,
                   const std::function<void(const std::filesystem::path& file, const std::string& said)>& written);

}  // namespace talus::render
