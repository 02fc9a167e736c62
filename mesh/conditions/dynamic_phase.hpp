#pragma once
// The phase of an analysis in which waves travel.
#include <tuple>

#include "core/fields.hpp"

namespace talus {

/// The dynamic phase begins with the first stage with inertia (type run).  Records and waves count their time from there, and absorbing
/// boundaries, which hold the model before, become dashpots.
struct DynamicPhase {
  bool begun = false;
  Real begin = 0;  ///< time at which it begins [s]
  static constexpr auto fields() { return std::tuple{saved("begun", &DynamicPhase::begun), saved("begin", &DynamicPhase::begin)}; }
};

}  // namespace talus
