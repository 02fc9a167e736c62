#pragma once
// Options of the commands that join their pictures to a movie.
#include <filesystem>
#include <optional>

#include "core/types.hpp"

namespace talus {

struct MovieOptions {
  std::optional<std::filesystem::path> movie;  ///< a .mp4 or .gif of all pictures
  Real per_second = 10;                        ///< pictures of the movie
  bool keep_frames = false;
};

}  // namespace talus
