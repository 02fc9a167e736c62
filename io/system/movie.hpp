#pragma once
// A movie from a series of pictures.
#include <filesystem>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// The error in a name of a movie; empty if it is valid.
std::string movie_problem(const std::filesystem::path& file);

/// Throws EnvironmentError, with the package to install, if ffmpeg is missing.
void require_movie_maker();

/// Writes .mp4 (H.264, 4:2:0, which every browser and office program plays) or .gif (a palette of the whole series), atomically.  An odd
/// number of pixels is increased by one, in white.  Throws EnvironmentError.
void make_movie(const std::vector<std::filesystem::path>& pictures, Real per_second, const std::filesystem::path& file);

}  // namespace talus
