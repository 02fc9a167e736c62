#pragma once
// Command talus render.
#include <filesystem>
#include <string>
#include <vector>

#include "app/commands/pictures/movie_options.hpp"

namespace talus {

struct RenderOptions : MovieOptions {
  std::filesystem::path folder;
  std::vector<std::string> words;  ///< render::picture_options with their values
};
/// Draws the results in a folder, with the defaults of the scene.  Throws Error with all errors of the options before anything is drawn;
/// EnvironmentError.
void render_results(const RenderOptions& options);

}  // namespace talus
