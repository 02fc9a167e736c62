#pragma once
// Initial positions of particles in a cell: symmetric points of equal weight, so that each has the same volume.
#include <array>
#include <optional>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// Barycentric coordinates of n points of weight 1/n: strictly inside, symmetric under every exchange of corners, their centroid
/// that of the cell.  All but n = 1 integrate quadratic polynomials exactly (2-D n = 6, 24, 54, 96 and 3-D n = 10: cubic ones).
/// Nothing for an n that has no such set; see seeding_counts().
template <int D>
std::optional<std::vector<std::array<Real, D + 1>>> seeding_points(int n);

/// The n that seeding_points() knows, ascending.  2-D: 1, 3 or 6 times a square up to 100.  3-D: 1, 4, 8, 10, 14, 20, 35, 56.
template <int D>
std::vector<int> seeding_counts();

}  // namespace talus
