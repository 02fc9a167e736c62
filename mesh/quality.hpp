#pragma once
// Measures of mesh quality: the quantities that determine time step and error, and the position of the worst cell.
#include <string>

#include "mesh/mesh.hpp"
#include "mesh/simplex.hpp"

namespace talus {

/// 1 for a regular simplex, towards 0 for a flat one: 4 sqrt(3) A / sum l^2 in 2-D, 12 (3 V)^(2/3) / sum l^2 in 3-D, l being the
/// edges (A. Liu, B. Joe, BIT 34 (1994) 268).
template <int D>
Real mean_ratio(const Simplex<D>& s) noexcept;

/// Smallest angle of a triangle, smallest dihedral angle of a tetrahedron [rad].
template <int D>
Real smallest_angle(const Simplex<D>& s) noexcept;

/// From node n to the centroid of the cells around it, weighted by volume: c_n - x_n [m].  The averaged gradient of the kernel `projected`
/// at n belongs to c_n (docs/theory/kernels.md).  `star`: the cells at n, one at least.
template <int D>
Vec<D> star_offset(std::span<const Vec<D>> nodes, std::span<const std::array<Index, D + 1>> cells, std::span<const Index> star,
                   Index n) noexcept;

/// Lengths of star_offset() relative to the mean length of the edges at the node, |c_n - x_n| / h_n, over interior nodes.  Nodes of the
/// boundary are left out: their cells lie on one side, so that they have about 0.4 on the most regular mesh too, and have to stay.
template <int D>
struct StarOffsets {
  Index nodes = 0;                         ///< interior nodes; all other members are zero if there is none
  Real median = 0, most = 0, largest = 0;  ///< `most`: 95 % of the nodes have this or less
  Vec<D> largest_place = Vec<D>::Zero();   ///< node with the largest [m]
};

template <int D>
StarOffsets<D> star_offsets(const Mesh<D>& mesh);

/// Medians above this cost accuracy.  The bending beam of benchmarks/cantilever with 8 cells over its height on a jittered grid: median 0,
/// 0.07, 0.14, 0.21: error 3.1, 4.0, 7.7, 7.2 % of the deflection.  Tetrahedra of gmsh have 0.11 and lose nothing that was measurable.
inline constexpr Real large_star_offset = 0.12;

/// One line of text; empty if there is no interior node.
template <int D>
std::string to_string(const StarOffsets<D>& offsets);

/// What to do about a median above `large_star_offset`, as one line of text; otherwise empty.
template <int D>
std::string advice(const StarOffsets<D>& offsets);

template <int D>
struct MeshQuality {
  Index nodes, cells, boundary_facets;
  Real volume, smallest_volume, largest_volume;  ///< area in 2-D [m^D]; of all cells, of the smallest, of the largest cell
  Real smallest_mean_ratio, average_mean_ratio;  ///< mean_ratio()
  Real smallest_angle;                           ///< of the whole mesh [rad]
  Real smallest_altitude, median_altitude;       ///< smallest and median of the smallest altitudes of the cells [m]
  Real shortest_edge, longest_edge;              ///< [m]
  Real gradation;                                ///< largest ratio of sizes, volume^(1/D), of two cells with a common facet
  Index largest_ring;                            ///< most nodes in the one-ring of a node, including itself
  Index worst_cell;                              ///< cell with the lowest mean ratio
  Vec<D> worst_place;                            ///< centroid of that cell [m]
  StarOffsets<D> offsets;                        ///< of the nodes from the centres of their cells
};

template <int D>
MeshQuality<D> quality(const Mesh<D>& mesh);

/// The measures as a few lines of text with units.
template <int D>
std::string to_string(const MeshQuality<D>& q);

}  // namespace talus
