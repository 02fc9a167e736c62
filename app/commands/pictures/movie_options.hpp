#pragma once
// Options of the commands that can make a movie of their pictures.
#include <filesystem>
#include <optional>

#include "core/types.hpp"

namespace talus {

struct MovieOptions {
  std::optional<std::filesystem::path> movie;  ///< .mp4 or .gif of all pictures
  Real per_second = 10;                        ///< pictures per second
  bool keep_frames = false;
};

}  // namespace talus
