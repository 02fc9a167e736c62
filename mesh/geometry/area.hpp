#pragma once
// Areas and lines on a map.
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// A position (east, north) [m] on the map.
using MapPlace = std::array<Real, 2>;
/// A line through these positions; the boundary of an area is closed without repeating the first.
using MapLine = std::vector<MapPlace>;

/// An area: the points inside an odd number of rings.
struct Area {
  std::vector<MapLine> rings;
  bool contains(const MapPlace& place) const noexcept;
};

/// The rectangle between two corners.
Area rectangle(const MapPlace& corner, const MapPlace& opposite);
/// The lower and upper corner of the bounding box of all rings.
std::pair<MapPlace, MapPlace> bounds_of(const Area& area) noexcept;
/// A position where two sides of a ring meet that are not neighbours, or where two neighbours overlap.
std::optional<MapPlace> crossing_of(const MapLine& ring);
/// Closed lines whose sides inside the rectangle are those of the ring: the ring itself if it lies in the rectangle, nothing if none of its
/// sides does, and otherwise each piece of it from border to border, closed counterclockwise along the border.  A ring without
/// self-intersection gives lines without self-intersection.
std::vector<MapLine> cut_to(const MapLine& ring, const MapPlace& low, const MapPlace& high);
/// The fractions, in (0, 1), of the way from one position to another at which it crosses the outline, in any order.
std::vector<Real> crossings(const Area& area, const MapPlace& from, const MapPlace& to);
/// The distance [m] of a position to an open line, or to a single point.
Real distance(const MapLine& line, const MapPlace& place) noexcept;

}  // namespace talus
