#pragma once
// Areas and lines on a map.
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// (east, north) [m]
using MapPlace = std::array<Real, 2>;
/// Through these places; closed where it bounds an area, without repeating the first.
using MapLine = std::vector<MapPlace>;

/// What lies inside an odd number of rings.
struct Area {
  std::vector<MapLine> rings;
  bool contains(const MapPlace& place) const noexcept;
};

/// The rectangle between two corners.
Area rectangle(const MapPlace& corner, const MapPlace& opposite);
/// Lower and upper corner of what holds all rings.
std::pair<MapPlace, MapPlace> bounds_of(const Area& area) noexcept;
/// A place where two sides of a ring meet that are no neighbours, or where two neighbours lie upon each other.
std::optional<MapPlace> crossing_of(const MapLine& ring);
/// Closed lines whose sides inside the rectangle are those of the ring: the ring itself if it lies in the rectangle, nothing if none of its
/// sides does, and otherwise each piece of it from border to border, closed along the border counterclockwise.  A ring that does not meet itself
/// gives lines that do not.
std::vector<MapLine> cut_to(const MapLine& ring, const MapPlace& low, const MapPlace& high);
/// Shares, in (0, 1), of the way from one place to the other at which it crosses the outline; in any order.
std::vector<Real> crossings(const Area& area, const MapPlace& from, const MapPlace& to);
/// Distance [m] to an open line; of one place, to that.
Real distance(const MapLine& line, const MapPlace& place) noexcept;

}  // namespace talus
