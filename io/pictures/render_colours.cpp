// Colour maps and scales.
#include "io/pictures/render_colours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talus::render {

namespace {

constexpr Colour no_value{190, 190, 190};
constexpr Real widest_log = 1e6;  // largest ratio to the smallest shown value: below it logarithms show round-off

constexpr std::size_t n_points = 17;
using Points = std::array<std::uint32_t, n_points>;

/// Seventeen points of each; straight lines between them stay within 0.022, 0.042 and 0.034 of it.
/// Viridis: S. van der Walt, N. Smith, 2015, CC0.
constexpr Points viridis{0x440154, 0x48186a, 0x472d7b, 0x424086, 0x3b528b, 0x33638d, 0x2c728e, 0x26828e, 0x21918c,
                         0x1fa088, 0x28ae80, 0x3fbc73, 0x5ec962, 0x84d44b, 0xaddc30, 0xd8e219, 0xfde725};
/// J. R. Nunez, C. R. Anderton, R. S. Renslow, PLoS ONE 13 (2018) e0199239, CC0.
constexpr Points cividis{0x00224e, 0x002e6a, 0x1a386f, 0x32436d, 0x434e6c, 0x535a6d, 0x61656f, 0x6f7073, 0x7d7c78,
                         0x8c8878, 0x9b9476, 0xaba072, 0xbcae6c, 0xcdbb63, 0xdec958, 0xf0d846, 0xfee838};
/// K. Moreland, Diverging color maps for scientific visualization, ISVC 2009.
constexpr Points coolwarm{0x3b4cc0, 0x4e68d8, 0x6282ea, 0x779af7, 0x8db0fe, 0xa3c2fe, 0xb9d0f9, 0xccd9ed, 0xdddcdc,
                          0xecd3c5, 0xf5c4ac, 0xf7b093, 0xf4987a, 0xeb7d62, 0xdd5f4b, 0xca3b37, 0xb40426};

const Points& points_of(Map map)
{
  switch (map) {
    case Map::cividis: return cividis;
    case Map::coolwarm: return coolwarm;
    case Map::viridis: break;
  }
  return viridis;
}

Real channel(std::uint32_t rgb, int c) { return static_cast<Real>((rgb >> (16 - 8 * c)) & 0xff); }

}  // namespace

Colour colour_of(Map map, Real share)
{
  if (std::isnan(share))
    return no_value;
  const Points& points = points_of(map);
  const Real place = std::clamp(share, 0.0, 1.0) * (n_points - 1);
  const auto left = std::min(static_cast<std::size_t>(place), n_points - 2);
  Colour colour{};
  for (int c = 0; c < 3; ++c)
    colour[static_cast<std::size_t>(c)] = static_cast<unsigned char>(
        std::lround(std::lerp(channel(points[left], c), channel(points[left + 1], c), place - static_cast<Real>(left))));
  return colour;
}

Real Scale::share(Real value) const
{
  const auto [low, high] = range;
  if (log && !(value > 0))
    return std::numeric_limits<Real>::quiet_NaN();  // zero has no logarithm
  return log ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
}

void Extent::add(const std::vector<Real>& values)
{
  for (const Real value : values) {
    if (!std::isfinite(value) || (log_ && !(value > 0)))
      continue;
    const bool first = ends_[0] > ends_[1];
    ends_ = {first ? value : std::min(ends_[0], value), first ? value : std::max(ends_[1], value)};
  }
}

std::array<Real, 2> Extent::range(bool balanced) const
{
  auto [low, high] = ends_;
  if (low > high)
    return log_ ? std::array{1.0, 10.0} : std::array{0.0, 1.0};
  const Real largest = std::max(std::abs(low), std::abs(high));
  if (log_)
    return high > low * (1 + 1e-6) ? std::array{std::max(low, high / widest_log), high} : std::array{low / 2, high * 2};
  if (balanced && low < 0 && high > 0)
    return {-largest, largest};
  if (high - low > 1e-6 * largest)  // single precision in the files has seven digits
    return {low, high};
  return largest > 0 ? std::array{low - 0.5 * largest, high + 0.5 * largest} : std::array{0.0, 1.0};
}

}  // namespace talus::render
