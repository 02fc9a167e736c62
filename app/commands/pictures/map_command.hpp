#pragma once
// Command talus map.
#include <filesystem>
#include <string>
#include <vector>

#include "app/commands/pictures/movie_options.hpp"

namespace talus {

struct MapOptions : MovieOptions {
  std::filesystem::path folder;
  std::vector<std::string> words;  ///< render::map_options and what follows them
};
/// Draws the maps and sections of a run with outputs.runout.  Errors as above.
void draw_maps(const MapOptions& options);

}  // namespace talus
