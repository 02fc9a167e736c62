#pragma once
// How far the points of a cloud are apart.
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// Typical distance of neighbouring points [m]: the median, over a sample of them, of the mean distance to the nearest 4 (2-D) or 6.
/// `positions`: 3 numbers a point.  Positive; one for fewer than two points.
Real spacing_of(std::span<const Real> positions, int dimension);

/// Radius at which points are drawn as disks or balls [m]: no gaps between neighbours, and a closed surface in 3-D.
inline Real drawn_radius(std::span<const Real> positions, int dimension)
{
  return (dimension == 2 ? 0.85 : 0.8) * spacing_of(positions, dimension);
}

/// Radius of each point [m], `radius` or larger, with which disks in the plane z = 0 leave no hole between neighbours.  A place is in a hole, and
/// is covered by the disk of the nearest point, unless a disk of 2.2 times the radius that has no point inside reaches it: that is a void, or the
/// outside (the closing of mathematical morphology).  It does not matter whether a narrow gap joins the hole to the outside.
/// `positions`: 3 numbers a point.
std::vector<Real> closing_radii(std::span<const Real> positions, Real radius);

/// How many times as far apart as usual neighbours of each particle are, where cells are not of one size.  It is made from the first frame only:
/// areas grow where matter comes apart, and what has come apart must not be drawn as if it were whole.
class Spread {
 public:
  Spread() = default;
  /// By the areas [m^2] that particles stand for; usual is the median.
  Spread(std::span<const std::int64_t> ids, std::span<const Real> areas);
  /// 1 for a particle that was not there.
  std::vector<Real> of(std::span<const std::int64_t> ids) const;

 private:
  std::unordered_map<std::int64_t, Real> of_id_;
};

/// The same with a `radius`, and so a width of voids, that grows with the spread of each point, in steps of the square root of two; it never
/// shrinks.
std::vector<Real> closing_radii(std::span<const Real> positions, Real radius, std::span<const Real> spread);

}  // namespace talus
