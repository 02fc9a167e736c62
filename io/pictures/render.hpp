#pragma once
// Pictures of a run: PNG files from result files.
#include <filesystem>
#include <functional>

#include "io/pictures/settings/picture_settings.hpp"

namespace talus::render {

/// Draws and calls `written` with every picture once it is on the disk.  Needs a display: EnvironmentError without DISPLAY, since
/// VTK would abort.  Error if the run does not have what is asked for; EnvironmentError if files cannot be read or written.
void make_pictures(const Settings& settings, const std::function<void(const std::filesystem::path&)>& written);

}  // namespace talus::render
