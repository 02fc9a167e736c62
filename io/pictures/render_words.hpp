#pragma once
// Round numbers for ticks and length scales.
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus::render {

/// The largest of 1, 2, 5 times a power of ten that is at most `length` (> 0).
Real round_below(Real length);

struct Tick {
  Real value;
  std::string text;
};
/// Multiples of a round step in [low, high], about five of them, with equal numbers of decimals.
std::vector<Tick> ticks(Real low, Real high);
/// Powers of ten in [low, high] (> 0), with twice and five times those if there are fewer than three.
std::vector<Tick> decades(Real low, Real high);

}  // namespace talus::render
