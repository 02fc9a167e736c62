#pragma once
// How far something is, in words for a terminal.
#include <string>

#include "core/types.hpp"

namespace talus {

/// "2:05", "1:02:05".
std::string in_minutes(Real seconds);

/// "#####     ", of so many characters; share from 0 to 1.
std::string bar(Real share, int width);

}  // namespace talus
