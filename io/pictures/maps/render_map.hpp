#pragma once
// Maps over a shaded ground, and sections through them, as PNG.
#include <filesystem>
#include <functional>

#include "io/pictures/settings/picture_settings.hpp"

namespace talus::render {

/// Draws the `maps` and `sections` in the results folder of a run with outputs.runout, and calls `written` with every picture that is on
/// the disk.  Needs a display.  Throws Error if a requested map does not exist, EnvironmentError if files cannot be read or written.
void draw_maps(const MapSettings& settings, const std::function<void(const std::filesystem::path&)>& written);

}  // namespace talus::render
