#pragma once
// Command talus surface.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace talus {

struct SurfaceOptions {
  std::filesystem::path folder;
  std::optional<std::string> body;  ///< name of the body; default: all bodies
  std::vector<std::string> words;   ///< render::surface_options with their values
};
/// Writes the surfaces of bodies and prints their volumes.  Errors as for render_results().
void extract_surface(const SurfaceOptions& options);

}  // namespace talus
