#pragma once
// Command talus surface.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace talus {

struct SurfaceOptions {
  std::filesystem::path folder;
  std::optional<std::string> body;  ///< its name; default all of them
  std::vector<std::string> words;   ///< render::surface_options and what follows them
};
/// Writes the surfaces of bodies and prints how much they enclose.  Errors as above.
void extract_surface(const SurfaceOptions& options);

}  // namespace talus
