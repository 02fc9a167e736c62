#pragma once
// Starts talus-render.  VTK without a display aborts its process, so pictures are made in another process.
#include <filesystem>
#include <string>
#include <vector>

namespace talus {

struct RenderedFile {
  std::filesystem::path path;
  std::vector<std::string> said;  ///< lines of text about it
};

enum class Display : std::uint8_t { needed, not_needed };

/// Runs `talus_render arguments...`, through `xvfb-run -a` if a display is needed and DISPLAY is not set, and waits for it.  Its messages
/// are passed on to standard error.  Returns the files that it reports, each of which exists.  Throws EnvironmentError if xvfb-run is
/// missing (with the package to install), or if the program is missing, died or wrote nothing; Error with its message if it refused its
/// arguments (no such field, no such frame).
std::vector<RenderedFile> launch_render(const std::filesystem::path& talus_render, const std::vector<std::string>& arguments,
                                        Display display = Display::needed);
/// Runs the talus-render beside this program.
std::vector<RenderedFile> launch_render(const std::vector<std::string>& arguments, Display display = Display::needed);

}  // namespace talus
