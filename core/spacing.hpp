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

/// Radius of each point [m], `radius` or larger, with which disks in the plane z = 0 leave no hole between neighbours.  A place is in a hole, and
/// is covered by the disk of the nearest point, unless a disk of 2.2 times the radius that has no point inside reaches it: that is a void, or the
/// outside (the closing of mathematical morphology).  It does not matter whether a narrow gap joins the hole to the outside.
/// `positions`: 3 numbers a point.
std::vector<Real> closing_radii(std::span<const Real> positions, Real radius);

}  // namespace talus
