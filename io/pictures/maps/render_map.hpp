#pragma once
// Maps over a hillshade of the ground, and sections through them, as PNG.
#include <filesystem>
#include <functional>

#include "io/pictures/settings/picture_settings.hpp"

namespace talus::render {

/// Draws what a run with outputs.runout has left in `maps` and `sections` of its folder and calls `written` with every picture once it is on
/// the disk.  Needs a display.  Error if there is nothing of what is asked for; EnvironmentError if files cannot be read or written.
void draw_maps(const MapSettings& settings, const std::function<void(const std::filesystem::path&)>& written);

}  // namespace talus::render
