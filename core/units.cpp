// Units with SI prefixes.
#include "core/units.hpp"

namespace talus {

ScaledUnit scaled_unit(const std::string& unit, Real largest)
{
  const auto scaled = [&](Real factor, const char* prefix) { return ScaledUnit{factor, prefix + unit}; };
  if (unit == "Pa" && largest >= 1e9)
    return scaled(1e-9, "G");
  if (unit == "Pa" && largest >= 1e6)
    return scaled(1e-6, "M");
  if (unit == "Pa" && largest >= 1e3)
    return scaled(1e-3, "k");
  if (unit == "m" && largest < 0.1)
    return scaled(1e3, "m");
  return {1, unit};
}

}  // namespace talus
