#pragma once
// Starts talus-render.  VTK without a display aborts its process, so pictures are made in another one.
#include <filesystem>
#include <string>
#include <vector>

namespace talus {

struct RenderedFile {
  std::filesystem::path path;
  std::vector<std::string> said;  ///< lines about it
};

enum class Display : std::uint8_t { needed, not_needed };

/// Runs `talus_render arguments...`, through `xvfb-run -a` when a display is needed and there is no DISPLAY, and waits for it.  Its messages go
/// on to standard error.  Returns the files it says it wrote, each of which has been seen on the disk.
/// EnvironmentError: xvfb-run is missing (says what to install), the program is missing, died, or wrote nothing;
/// Error with its message: it refused its arguments (no such field, no such frame).
std::vector<RenderedFile> launch_render(const std::filesystem::path& talus_render, const std::vector<std::string>& arguments,
                                        Display display = Display::needed);
/// The one beside this program.
std::vector<RenderedFile> launch_render(const std::vector<std::string>& arguments, Display display = Display::needed);

}  // namespace talus
