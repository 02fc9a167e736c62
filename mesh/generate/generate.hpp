#pragma once
// Boxes of triangles or tetrahedra, regular or distorted, for tests and benchmarks without a mesher.
#include <array>
#include <cstdint>

#include "mesh/mesh.hpp"

namespace talus {

/// The diagonals of the squares of a plane box: all along (0,0)-(1,1), all along (1,0)-(0,1), alternating like a chessboard, or random.
enum class Diagonals : std::uint8_t { rising, falling, alternating, random };

/// A structured box: squares of two triangles (rising diagonals), or bricks of six tetrahedra around a diagonal (H. W. Kuhn,
/// 1960).  Facet sets x_min, x_max, y_min, y_max (z_min, z_max) are its sides, the cell set `all` everything.
/// Throws std::invalid_argument unless low < high and every count is positive.
template <int D>
MeshData<D> box(Vec<D> low, Vec<D> high, std::array<Index, D> cells);
MeshData<2> box(Vec<2> low, Vec<2> high, std::array<Index, 2> cells, Diagonals diagonals, std::uint64_t seed = 1);

/// The treatment of boundary nodes by jittered().  Sliding nodes stay in the planes (lines) of all their boundary facets.
enum class BoundaryNodes : std::uint8_t { stay, slide };

/// Moves every node by up to `amount` times its shortest edge along each axis.  Where a cell would lose more than four fifths of its volume
/// the move is halved until it does not, so cells stay positive for any amount.
template <int D>
MeshData<D> jittered(MeshData<D> data, Real amount, std::uint64_t seed, BoundaryNodes boundary = BoundaryNodes::stay);

/// Spacing that grows exponentially along x, `ratio` times as large at the high end as at the low end (below one it decreases).  The size
/// of the box stays.
template <int D>
MeshData<D> graded(MeshData<D> data, Real ratio);

/// Flattens cells at `count` positions that share no node: an interior node is moved to a position just above the middle of the opposite
/// facet of one of its cells, so that the smallest (dihedral) angle around it is `angle` [rad].  If the next facet lies in the same plane,
/// as in a structured box of tetrahedra, its cell becomes flat as well.  Throws std::invalid_argument if the angle is not in (0, pi/6) or
/// there is not enough room.
template <int D>
MeshData<D> slivered(MeshData<D> data, Real angle, Index count, std::uint64_t seed);

}  // namespace talus
