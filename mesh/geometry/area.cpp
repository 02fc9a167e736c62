#include "mesh/geometry/area.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace talus {

namespace {

MapPlace minus(const MapPlace& a, const MapPlace& b) noexcept { return {a[0] - b[0], a[1] - b[1]}; }
Real cross(const MapPlace& a, const MapPlace& b) noexcept { return a[0] * b[1] - a[1] * b[0]; }
Real dot(const MapPlace& a, const MapPlace& b) noexcept { return a[0] * b[0] + a[1] * b[1]; }

/// The fraction of the way from a to b at which it meets the side from p to q.  Collinear sides do not meet.
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

/// Whether two collinear sides have more than an end in common.
bool overlap(const MapPlace& a, const MapPlace& b, const MapPlace& p, const MapPlace& q) noexcept
{
  const MapPlace way = minus(b, a);
  if (cross(way, minus(p, a)) != 0 || cross(way, minus(q, a)) != 0)
    return false;
  const Real from = dot(minus(p, a), way), to = dot(minus(q, a), way);
  return std::max(from, to) > 0 && std::min(from, to) < dot(way, way);
}

/// The part of the way from a to b inside the rectangle: its ends lie on the border where the way enters or leaves.  Nothing if only the
/// border is touched.
std::optional<std::pair<MapPlace, MapPlace>> part_in(const MapPlace& a, const MapPlace& b, const MapPlace& low,
                                                     const MapPlace& high) noexcept
{
  Real from = 0, to = 1;
  MapPlace first = a, last = b;
  std::optional<std::size_t> entry, exit;  // axes of the borders that are crossed
  for (std::size_t d = 0; d < 2; ++d) {
    const Real way = b[d] - a[d];
    if (way == 0 && (a[d] <= low[d] || a[d] >= high[d]))
      return std::nullopt;
    if (way == 0)
      continue;
    const Real near = ((way > 0 ? low[d] : high[d]) - a[d]) / way, far = ((way > 0 ? high[d] : low[d]) - a[d]) / way;
    if (near >= from && near >= 0)
      from = near, entry = d;
    if (far <= to)
      to = far, exit = d;
  }
  if (!(from < to))
    return std::nullopt;
  const auto on_border = [&](std::size_t axis, Real share, bool is_upper) {
    MapPlace place = at(a, b, share);
    for (std::size_t d = 0; d < 2; ++d)
      place[d] = std::clamp(place[d], low[d], high[d]);
    place[axis] = is_upper ? high[axis] : low[axis];
    return place;
  };
  if (entry)
    first = on_border(*entry, from, b[*entry] < a[*entry]);
  if (exit)
    last = on_border(*exit, to, b[*exit] > a[*exit]);
  return std::pair(first, last);
}

/// Closes a line that begins and ends on the border of the rectangle, counterclockwise along the border from its end to its beginning.
void close_along_border(const MapPlace& low, const MapPlace& high, MapLine& line)
{
  const std::array<MapPlace, 4> corners{{{low[0], low[1]}, {high[0], low[1]}, {high[0], high[1]}, {low[0], high[1]}}};
  const auto along = [&](const MapPlace& x) {  // distance along the border from the lower left corner, in sides
    if (x[1] == low[1] && x[0] < high[0])
      return (x[0] - low[0]) / (high[0] - low[0]);
    if (x[0] == high[0] && x[1] < high[1])
      return 1 + (x[1] - low[1]) / (high[1] - low[1]);
    if (x[1] == high[1] && x[0] > low[0])
      return 2 + (high[0] - x[0]) / (high[0] - low[0]);
    return 3 + (high[1] - x[1]) / (high[1] - low[1]);
  };
  if (line.front() == line.back()) {
    line.pop_back();
    return;
  }
  const Real from = along(line.back());
  Real to = along(line.front());
  if (to <= from)
    to += 4;
  for (auto corner = static_cast<std::size_t>(std::floor(from)) + 1; static_cast<Real>(corner) < to; ++corner)
    line.push_back(corners[corner % 4]);
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

// Sides are swept from west to east, so the cost for an outline of many short sides is little more than that of sorting them.
std::optional<MapPlace> crossing_of(const MapLine& ring)
{
  const std::size_t n = ring.size();
  const auto west = [&](std::size_t i) { return std::min(ring[i][0], ring[(i + 1) % n][0]); };
  const auto east = [&](std::size_t i) { return std::max(ring[i][0], ring[(i + 1) % n][0]); };
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return std::pair(west(i), i) < std::pair(west(j), j); });
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t m = k + 1; m < n && west(order[m]) <= east(order[k]); ++m) {
      const auto [i, j] = std::minmax(order[k], order[m]);
      const MapPlace &a = ring[i], &b = ring[(i + 1) % n], &p = ring[j], &q = ring[(j + 1) % n];
      if (overlap(a, b, p, q))
        return p;
      const bool neighbours = j == i + 1 || (j + 1) % n == i;
      if (const auto share = meeting(a, b, p, q); share && !neighbours)
        return at(a, b, *share);
    }
  return std::nullopt;
}

std::vector<MapLine> cut_to(const MapLine& ring, const MapPlace& low, const MapPlace& high)
{
  const auto is_inside = [&](const MapPlace& x) { return x[0] > low[0] && x[0] < high[0] && x[1] > low[1] && x[1] < high[1]; };
  const auto first_outside = std::find_if_not(ring.begin(), ring.end(), is_inside);
  if (first_outside == ring.end())
    return {ring};
  std::vector<MapLine> lines;
  const std::size_t n = ring.size(), start = static_cast<std::size_t>(first_outside - ring.begin());
  for (std::size_t i = 0; i < n; ++i) {
    const MapPlace &a = ring[(start + i) % n], &b = ring[(start + i + 1) % n];
    const bool from_inside = is_inside(a), to_inside = is_inside(b);
    auto piece = part_in(a, b, low, high);
    if (!piece && (from_inside || to_inside))
      piece.emplace(a, b);  // round-off: one end is on the border
    if (!piece)
      continue;
    if (!from_inside)
      lines.push_back({piece->first});
    lines.back().push_back(piece->second);
    if (!to_inside)
      close_along_border(low, high, lines.back());
  }
  return lines;
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
