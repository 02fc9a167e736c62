#pragma once
// Areas and lines on a map.
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// (east, north) [m]
using Place = std::array<Real, 2>;
/// Through these places; closed where it bounds an area, without repeating the first.
using Line = std::vector<Place>;

/// What lies inside an odd number of rings.
struct Area {
  std::vector<Line> rings;
  bool contains(const Place& place) const noexcept;
};

/// The rectangle between two corners.
Area rectangle(const Place& corner, const Place& opposite);
/// Lower and upper corner of what holds all rings.
std::pair<Place, Place> bounds_of(const Area& area) noexcept;
/// A place where two sides of a ring meet that are no neighbours, or where two neighbours lie upon each other.
std::optional<Place> crossing_of(const Line& ring) noexcept;
/// Shares, in (0, 1), of the way from one place to the other at which it crosses the outline; in any order.
std::vector<Real> crossings(const Area& area, const Place& from, const Place& to);
/// Distance [m] to an open line; of one place, to that.
Real distance(const Line& line, const Place& place) noexcept;

}  // namespace talus
