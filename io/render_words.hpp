#pragma once
// Numbers for people: round ticks, scale lengths, units with prefixes.
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus::render {

/// The largest of 1, 2, 5 times a power of ten that is not above `length` (> 0).
Real round_below(Real length);

struct Tick {
  Real value;
  std::string text;
};
/// Multiples of a round step in [low, high], about five of them, all with the same number of decimals.
std::vector<Tick> ticks(Real low, Real high);

struct ScaledUnit {
  Real factor;  ///< shown value over SI value
  std::string name;
};
/// kPa, MPa, GPa for large pressures, mm for small lengths; other units stay.
ScaledUnit scaled_unit(const std::string& unit, Real largest);

}  // namespace talus::render
