#include "mesh/area.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talus {

namespace {

MapPlace minus(const MapPlace& a, const MapPlace& b) noexcept { return {a[0] - b[0], a[1] - b[1]}; }
Real cross(const MapPlace& a, const MapPlace& b) noexcept { return a[0] * b[1] - a[1] * b[0]; }
Real dot(const MapPlace& a, const MapPlace& b) noexcept { return a[0] * b[0] + a[1] * b[1]; }

/// Share of the way from a to b at which it meets the side from p to q.  Sides in one line meet nowhere.
std::optional<Real> meeting(const MapPlace& a, const MapPlace& b, const MapPlace& p, const MapPlace& q) noexcept
{
  const MapPlace way = minus(b, a), side = minus(q, p), between = minus(p, a);
  const Real turned = cross(way, side);
  if (turned == 0)
    return std::nullopt;
  const Real along_way = cross(between, side) / turned, along_side = cross(between, way) / turned;
  const bool meet = along_way >= 0 && along_way <= 1 && along_side >= 0 && along_side <= 1;
  return meet ? std::optional(along_way) : std::nullopt;
}

MapPlace at(const MapPlace& a, const MapPlace& b, Real share) noexcept
{
  return {a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])};
}

/// True if two sides in one line have more than an end in common.
bool overlap(const MapPlace& a, const MapPlace& b, const MapPlace& p, const MapPlace& q) noexcept
{
  const MapPlace way = minus(b, a);
  if (cross(way, minus(p, a)) != 0 || cross(way, minus(q, a)) != 0)
    return false;
  const Real from = dot(minus(p, a), way), to = dot(minus(q, a), way);
  return std::max(from, to) > 0 && std::min(from, to) < dot(way, way);
}

}  // namespace

bool Area::contains(const MapPlace& place) const noexcept
{
  bool inside = false;
  for (const MapLine& ring : rings)
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      const MapPlace &a = ring[i], &b = ring[j];
      if ((a[1] > place[1]) != (b[1] > place[1]) && place[0] < a[0] + (b[0] - a[0]) * (place[1] - a[1]) / (b[1] - a[1]))
        inside = !inside;
    }
  return inside;
}

Area rectangle(const MapPlace& corner, const MapPlace& opposite)
{
  const Real west = std::min(corner[0], opposite[0]), east = std::max(corner[0], opposite[0]);
  const Real south = std::min(corner[1], opposite[1]), north = std::max(corner[1], opposite[1]);
  return {{{{west, south}, {east, south}, {east, north}, {west, north}}}};
}

std::pair<MapPlace, MapPlace> bounds_of(const Area& area) noexcept
{
  constexpr Real infinity = std::numeric_limits<Real>::infinity();
  MapPlace low{infinity, infinity}, high{-infinity, -infinity};
  for (const MapLine& ring : area.rings)
    for (const MapPlace& place : ring)
      for (std::size_t d = 0; d < 2; ++d) {
        low[d] = std::min(low[d], place[d]);
        high[d] = std::max(high[d], place[d]);
      }
  return {low, high};
}

std::optional<MapPlace> crossing_of(const MapLine& ring) noexcept
{
  const std::size_t n = ring.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) {
      const MapPlace &a = ring[i], &b = ring[(i + 1) % n], &p = ring[j], &q = ring[(j + 1) % n];
      if (overlap(a, b, p, q))
        return p;
      const bool neighbours = j == i + 1 || (j + 1) % n == i;
      if (const auto share = meeting(a, b, p, q); share && !neighbours)
        return at(a, b, *share);
    }
  return std::nullopt;
}

std::vector<Real> crossings(const Area& area, const MapPlace& from, const MapPlace& to)
{
  std::vector<Real> shares;
  for (const MapLine& ring : area.rings)
    for (std::size_t i = 0; i < ring.size(); ++i)
      if (const auto share = meeting(from, to, ring[i], ring[(i + 1) % ring.size()]); share && *share > 0 && *share < 1)
        shares.push_back(*share);
  return shares;
}

Real distance(const MapLine& line, const MapPlace& place) noexcept
{
  Real least = std::hypot(place[0] - line[0][0], place[1] - line[0][1]);
  for (std::size_t i = 1; i < line.size(); ++i) {
    const MapPlace way = minus(line[i], line[i - 1]);
    const Real length2 = dot(way, way);
    const Real share = length2 > 0 ? std::clamp(dot(minus(place, line[i - 1]), way) / length2, Real{0}, Real{1}) : 0;
    const MapPlace nearest = at(line[i - 1], line[i], share);
    least = std::min(least, std::hypot(place[0] - nearest[0], place[1] - nearest[1]));
  }
  return least;
}

}  // namespace talus
