#pragma once
// Random numbers that are equal on all platforms: the distributions of the standard library differ between libraries.
#include <random>

#include "core/types.hpp"

namespace talus {

/// A uniform random number in [0, 1).
inline Real uniform(std::mt19937_64& random) noexcept { return static_cast<Real>(random() >> 11) * 0x1p-53; }

}  // namespace talus
