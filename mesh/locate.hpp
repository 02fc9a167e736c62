#pragma once
// The cell that contains a point: a walk across facets from a hint, and a search in a tree of boxes if the walk fails.
#include <optional>

#include "mesh/geometry/box_tree.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// The distance outside a cell, relative to its longest edge, up to which a point counts as inside: round-off.
inline constexpr Real location_tolerance = 1e-10;

/// Finds cells of points.  On a facet, edge or node of several cells the lowest cell number is returned, whatever the hint.  In a part of a
/// mesh (see Mesh) the result is that of the whole mesh if the part contains the cells that share a node with the cell of the point; a
/// point in a cell that the part does not contain is outside.
template <int D>
class Locator {
 public:
  explicit Locator(const Mesh<D>& mesh);

  /// Cell of x, or nothing if x is outside the mesh by more than round-off (1e-10 of the cell's size), or not finite.
  /// The usual case, x still inside cell `hint`, costs one barycentric map.  `hint` may be `none`.
  std::optional<Index> operator()(const Mesh<D>& mesh, const Vec<D>& x, Index hint) const noexcept;

  /// A point whose barycentric coordinates in the cell are all above this lies in no other cell: most particles are well inside theirs.
  Real least_inside(const Mesh<D>& mesh, Index c) const noexcept { return margin_ / mesh.altitude(c); }

  /// The point of the mesh boundary nearest to x and its cell, for x outside: the projection on the nearest boundary facet.
  /// x must be finite.  A part from the inside of a mesh may have no boundary facets: the point is then infinitely far, and neither cell
  /// nor facet mean anything.
  struct Nearest {
    Vec<D> x;
    Index cell;
    Facet facet;
  };
  Nearest nearest(const Mesh<D>& mesh, const Vec<D>& x) const noexcept;

 private:
  std::optional<Index> search(const Mesh<D>& mesh, const Vec<D>& x) const noexcept;

  Real margin_;  // a point this deep [m] inside a cell is not within the tolerance of any other cell of the whole mesh
  BoxTree<D> cells_, facets_;
};

extern template class Locator<2>;
extern template class Locator<3>;

}  // namespace talus
