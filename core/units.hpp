#pragma once
// Units with SI prefixes, for display.
#include <string>

#include "core/types.hpp"

namespace talus {

struct ScaledUnit {
  Real factor;  ///< shown value over SI value
  std::string name;
};
/// kPa, MPa, GPa for large pressures, mm for small lengths; other units stay.
ScaledUnit scaled_unit(const std::string& unit, Real largest);

}  // namespace talus
