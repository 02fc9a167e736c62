#pragma once
// Commands talus map, talus render and talus surface: pictures and surfaces of the results of a run.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/commands/pictures/movie_command.hpp"

namespace talus {

struct MapOptions : MovieOptions {
  std::filesystem::path folder;
  std::vector<std::string> words;  ///< render::map_options with their values
};
/// Draws the maps and sections of a run with outputs.runout.  Errors as for render_results().
void draw_maps(const MapOptions& options);

struct RenderOptions : MovieOptions {
  std::filesystem::path folder;
  std::vector<std::string> words;  ///< render::picture_options with their values
};
/// Draws the results in a folder, with the defaults of the scene.  Throws Error with all errors of the options before anything is drawn;
/// EnvironmentError.
void render_results(const RenderOptions& options);

struct SurfaceOptions {
  std::filesystem::path folder;
  std::optional<std::string> body;  ///< name of the body; default: all bodies
  std::vector<std::string> words;   ///< render::surface_options with their values
};
/// Writes the surfaces of bodies and prints their volumes.  Errors as for render_results().
void extract_surface(const SurfaceOptions& options);

}  // namespace talus
