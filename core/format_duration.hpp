#pragma once
// How far something is, in words for a terminal.
#include <string>

#include "core/types.hpp"

namespace talus {

/// "2:05", "1:02:05": of what counts down.
std::string in_minutes(Real seconds);

/// "3 min 20 s", "2.5 s", "4 h 10 min": of an estimate.
std::string duration_in_words(Real seconds);

/// "#####     ", of so many characters; share from 0 to 1.
std::string bar(Real share, int width);

}  // namespace talus
