#pragma once
// Pictures of talus-render as a movie.
#include <string>
#include <vector>

#include "app/commands/pictures/movie_options.hpp"

namespace talus {

/// What is wrong with the movie asked for, if one is; `words` are those of talus-render.
void check_movie(const MovieOptions& options, const std::vector<std::string>& words, std::vector<std::string>& problems);

/// Has talus-render draw what the words say, makes a movie of it, and prints its name.
void make_movie(const MovieOptions& options, std::vector<std::string> words);

}  // namespace talus
