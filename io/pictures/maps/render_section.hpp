#pragma once
// A section through the maps of a run as a picture.
#include <filesystem>

#include "io/pictures/settings/picture_settings.hpp"

namespace talus::render {

/// Draws a line for each surface, and fills the area between the ground before and the surface after.
void draw_section(const MapSettings& settings, const std::filesystem::path& file, const std::filesystem::path& png);

}  // namespace talus::render
