#pragma once
// A surface over the plan: ground, bottom of a layer or water table.
#include <array>
#include <functional>

#include "core/types.hpp"

namespace talus {

/// The elevation [m] at a position of the map [m]: (east, north), in 2-D without a section (x, 0).  NaN where it is unknown.
using Surface = std::function<Real(const std::array<Real, 2>& place)>;

/// A rectangle on the map [m].
struct MapBox {
  Real west = 0, south = 0, east = 0, north = 0;
};

}  // namespace talus
