#pragma once
// Pictures of a run: PNG files from result files.
#include <filesystem>
#include <functional>

#include "io/pictures/settings/picture_settings.hpp"

namespace talus::render {

/// Draws pictures and calls `written` with every picture that is on the disk.  Needs a display: throws EnvironmentError without DISPLAY,
/// because VTK would abort.  Throws Error if the run does not have a requested item, EnvironmentError if files cannot be read or written.
void make_pictures(const Settings& settings, const std::function<void(const std::filesystem::path&)>& written);

}  // namespace talus::render
