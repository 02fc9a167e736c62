#pragma once
// A section through the maps of a run as a picture.
#include <filesystem>

#include "io/pictures/settings/picture_settings.hpp"

namespace talus::render {

/// A line per surface; what lies between the ground before and the surface after is filled.
void draw_section(const MapSettings& settings, const std::filesystem::path& file, const std::filesystem::path& png);

}  // namespace talus::render
