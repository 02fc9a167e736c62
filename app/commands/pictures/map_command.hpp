#pragma once
// Command talus map.
#include <filesystem>
#include <string>
#include <vector>

#include "app/commands/pictures/movie_options.hpp"

namespace talus {

struct MapOptions : MovieOptions {
  std::filesystem::path folder;
  std::vector<std::string> words;  ///< render::map_options with their values
};
/// Draws the maps and sections of a run with outputs.runout.  Errors as for render_results().
void draw_maps(const MapOptions& options);

}  // namespace talus
