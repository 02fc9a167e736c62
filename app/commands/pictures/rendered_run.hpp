#pragma once
// The results of a run to be drawn.
#include <filesystem>
#include <string>
#include <vector>

#include "io/pictures/settings/picture_settings.hpp"
#include "io/scene/scene.hpp"

namespace talus {

struct RenderedRun {
  Scene scene;
  render::RunFacts facts;
};
/// Throws Error if the folder contains no results of a run, EnvironmentError if it contains none of particles.
RenderedRun read_rendered_run(const std::filesystem::path& folder);

/// Whether an option is among the words of a command line.
bool has_option(const std::vector<std::string>& words, std::string_view option);

}  // namespace talus
