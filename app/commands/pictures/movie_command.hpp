#pragma once
// Movies from pictures of talus-render, and the options of the commands that can make one.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

struct MovieOptions {
  std::optional<std::filesystem::path> movie;  ///< .mp4 or .gif of all pictures
  Real per_second = 10;                        ///< pictures per second
  bool keep_frames = false;
};

/// Whether an option is among the words of a command line.
bool has_option(const std::vector<std::string>& words, std::string_view option);

/// Adds the errors of the options of a movie, if there is one; `words` are those of talus-render.
void check_movie(const MovieOptions& options, const std::vector<std::string>& words, std::vector<std::string>& problems);

/// Draws pictures by talus-render, makes a movie of them, and prints its name.
void make_movie(const MovieOptions& options, std::vector<std::string> words);

}  // namespace talus
