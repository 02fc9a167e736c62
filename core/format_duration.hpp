#pragma once
// Durations and progress as text for a terminal.
#include <string>

#include "core/types.hpp"

namespace talus {

/// A remaining or elapsed time [s] as "2:05" or "1:02:05".
std::string in_minutes(Real seconds);

/// An estimated time [s] as "3 min 20 s", "2.5 s" or "4 h 10 min".
std::string duration_in_words(Real seconds);

/// A progress bar of `width` characters, such as "#####     "; share in [0, 1].
std::string bar(Real share, int width);

}  // namespace talus
