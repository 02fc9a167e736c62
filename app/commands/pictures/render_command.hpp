#pragma once
// Command talus render.
#include <filesystem>
#include <string>
#include <vector>

#include "app/commands/pictures/movie_options.hpp"

namespace talus {

struct RenderOptions : MovieOptions {
  std::filesystem::path folder;
  std::vector<std::string> words;  ///< render::picture_options and what follows them
};
/// Draws the results in a folder; what is not asked for is as the scene says.  Error with all that is wrong with the words, before anything is
/// drawn; EnvironmentError.
void render_results(const RenderOptions& options);

}  // namespace talus
