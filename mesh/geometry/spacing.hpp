#pragma once
// The spacing of the points of a cloud.
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// The typical distance of neighbouring points [m]: the median, over a sample of them, of the mean distance to the nearest 4 (2-D) or 6
/// points.  `positions`: 3 numbers per point.  Positive; 1 for fewer than two points.
Real spacing_of(std::span<const Real> positions, int dimension);

/// The radius [m] with which points are drawn as disks or balls, so that neighbours leave no gaps and 3-D surfaces are closed.
inline Real drawn_radius(std::span<const Real> positions, int dimension)
{
  return (dimension == 2 ? 0.85 : 0.8) * spacing_of(positions, dimension);
}

/// The radius of each point [m], at least `radius`, with which disks in the plane z = 0 leave no hole between neighbours.  A position is in
/// a hole, and is covered by the disk of the nearest point, unless a disk of 2.2 times the radius without points inside reaches it: such a
/// position is in a void or outside (the closing of mathematical morphology).  A narrow gap between a hole and the outside does not matter.
/// `positions`: 3 numbers per point.
std::vector<Real> closing_radii(std::span<const Real> positions, Real radius);

/// The spacing of each particle relative to the usual one, for meshes with cells of different sizes.  It is computed from the first frame
/// only: areas grow where material separates, and separated material must not be drawn as connected.
class Spread {
 public:
  Spread() = default;
  /// Uses the areas [m^2] that the particles represent, relative to the median.
  Spread(std::span<const std::int64_t> ids, std::span<const Real> areas);
  /// The relative spacing of each particle; 1 for a particle that was not in the first frame.
  std::vector<Real> of(std::span<const std::int64_t> ids) const;

 private:
  std::unordered_map<std::int64_t, Real> of_id_;
};

/// As closing_radii() above, with a `radius` and a width of voids that increase with the spread of each point, in steps of the square root
/// of two; the radius never decreases below `radius`.
std::vector<Real> closing_radii(std::span<const Real> positions, Real radius, std::span<const Real> spread);

}  // namespace talus
