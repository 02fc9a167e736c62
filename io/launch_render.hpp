#pragma once
// Starts talus-render.  VTK without a display aborts its process, so pictures are made in another one.
#include <filesystem>
#include <string>
#include <vector>

namespace talus {

/// Runs `talus_render arguments...`, through `xvfb-run -a` when there is no DISPLAY, and waits for it.  Its messages go on to
/// standard error.  Returns the pictures it says it wrote, each of which has been seen on the disk.
/// EnvironmentError: xvfb-run is missing (says what to install), the program is missing, died, or wrote no picture;
/// Error with its message: it refused its arguments (no such field, no such frame).
std::vector<std::filesystem::path> launch_render(const std::filesystem::path& talus_render, const std::vector<std::string>& arguments);

}  // namespace talus
