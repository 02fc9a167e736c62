#pragma once
// Pictures one after the other, as one file.
#include <filesystem>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// What is wrong with such a name of a movie; empty if nothing is.
std::string movie_problem(const std::filesystem::path& file);

/// EnvironmentError, which says what to install: the program that makes movies is missing.
void require_movie_maker();

/// .mp4 (H.264, 4:2:0, which every browser and office program plays) or .gif (a palette of the whole series), whole or not at all.
/// An odd number of pixels gets one more, in white.  EnvironmentError.
void make_movie(const std::vector<std::filesystem::path>& pictures, Real per_second, const std::filesystem::path& file);

}  // namespace talus
