#pragma once
// Movies from pictures of talus-render.
#include <string>
#include <vector>

#include "app/commands/pictures/movie_options.hpp"

namespace talus {

/// Adds the errors of the options of a movie, if there is one; `words` are those of talus-render.
void check_movie(const MovieOptions& options, const std::vector<std::string>& words, std::vector<std::string>& problems);

/// Draws pictures by talus-render, makes a movie of them, and prints its name.
void make_movie(const MovieOptions& options, std::vector<std::string> words);

}  // namespace talus
