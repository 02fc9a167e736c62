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
};

template <int D>
MeshQuality<D> quality(const Mesh<D>& mesh);

/// The measures as a few lines of text with units.
template <int D>
std::string to_string(const MeshQuality<D>& q);

}  // namespace talus
