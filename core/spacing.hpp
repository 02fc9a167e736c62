#pragma once
// How far the points of a cloud are apart.
#include <span>
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

/// Radius of each point [m], `radius` or larger, with which disks in the plane z = 0 leave no hole that other disks enclose.  Holes wider than
/// 1.8 times the radius are voids and stay open; so does what is open to the outside.  `positions`: 3 numbers a point.
std::vector<Real> closing_radii(std::span<const Real> positions, Real radius);

}  // namespace talus
