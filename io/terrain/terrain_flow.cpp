#include "io/terrain/terrain_flow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace talus {

namespace {

bool is_in_domain(const TerrainInput& input, const MapPlace& place)
{
  if (!input.is_line)
    return input.domain.contains(place);
  const MapFrame& frame = input.frame;
  const Real x = (place[0] - frame.origin[0]) * frame.along[0] + (place[1] - frame.origin[1]) * frame.along[1];
  return x >= input.from && x <= input.to;
}

/// The lowest position on the smallest circle with a position lower than its centre.
std::optional<MapPlace> lower_place(const TerrainInput& input, const MapPlace& from, Real stride)
{
  const int directions = input.is_line ? 2 : 36;
  constexpr Real widest = 8;  // largest radius in strides
  const auto& [along_x, along_y] = input.frame.along;
  for (Real radius = stride; radius <= widest * stride; radius *= 2) {
    std::optional<MapPlace> best;
    Real lowest = input.ground(from);
    for (int i = 0; i < directions; ++i) {
      const Real angle = 2 * std::numbers::pi * i / directions, c = std::cos(angle), s = std::sin(angle);
      const MapPlace place{from[0] + radius * (c * along_x - s * along_y), from[1] + radius * (c * along_y + s * along_x)};
      if (!is_in_domain(input, place))
        continue;
      if (const Real height = input.ground(place); height < lowest)
        lowest = height, best = place;
    }
    if (best)
      return best;
  }
  return std::nullopt;
}

/// The thickness of a layer; zero where it is cut away.
Real thickness_at(const TerrainInput& input, std::size_t layer, const MapPlace& place)
{
  if (!is_in_domain(input, place) || (input.within[layer] && !input.within[layer]->contains(place)))
    return 0;
  Real above = input.ground(place);
  for (std::size_t l = 0; l < layer; ++l)
    if (const Real bottom = input.bottoms[l](place); bottom < above)
      above = bottom;
  const Real thickness = above - input.bottoms[layer](place);
  return thickness > 0 ? thickness : 0;
}

}  // namespace

std::optional<MapPlace> centre_of_layer(const TerrainInput& input, std::size_t layer)
{
  constexpr Index samples = 200;  // samples along each axis
  Real total = 0;
  MapPlace sum{};
  const auto add = [&](const MapPlace& place) {
    const Real thickness = thickness_at(input, layer, place);
    total += thickness;
    sum[0] += thickness * place[0], sum[1] += thickness * place[1];
  };
  const auto [low, high] = bounds_of(input.domain);
  for (Index i = 0; i < samples; ++i) {
    const Real share = (i + 0.5) / samples;
    if (input.is_line)
      add(input.frame.to_map(input.from + share * (input.to - input.from)));
    for (Index j = 0; j < (input.is_line ? 0 : samples); ++j)
      add({low[0] + share * (high[0] - low[0]), low[1] + (high[1] - low[1]) * (j + 0.5) / samples});
  }
  if (total == 0)
    return std::nullopt;
  return MapPlace{sum[0] / total, sum[1] / total};
}

MapLine steepest_descent(const TerrainInput& input, const MapPlace& from, Real stride)
{
  MapLine line{from};
  while (const auto next = lower_place(input, line.back(), stride))
    line.push_back(*next);
  return line;
}

EnergyLines::EnergyLines(std::vector<std::array<Real, 3>> sources, Real fall) : fall_(fall)
{
  std::sort(sources.begin(), sources.end(), [](const auto& a, const auto& b) { return a[2] > b[2]; });
  for (const auto& source : sources)
    if (height({source[0], source[1]}) < source[2])
      highest_.push_back(source);
}

Real EnergyLines::height(const MapPlace& place) const noexcept
{
  Real best = -std::numeric_limits<Real>::infinity();
  for (const auto& [x, y, z] : highest_)
    best = std::max(best, z - fall_ * std::hypot(place[0] - x, place[1] - y));
  return best;
}

}  // namespace talus
