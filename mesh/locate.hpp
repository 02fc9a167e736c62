#pragma once
// The cell that contains a point: a walk across facets from a hint, and a search in a tree of boxes if the walk fails.
#include <optional>

#include "core/simd.hpp"
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

  /// Data of one cell for the location of many points: most particles are still well inside their cell.
  struct Probe {
    const Vec<D>& origin;
    const std::array<Vec<D>, D + 1>& slope;  ///< gradients of the barycentric coordinates [1/m]
    Real least;                              ///< a point whose coordinates are all above this lies in no other cell
    bool deep(const Vec<D>& x) const noexcept { return all_above_least<Real>(x); }
    /// The test for several points at once.
    SimdReal::Mask deep_each(const Eigen::Matrix<SimdReal, D, 1, Eigen::DontAlign>& x) const noexcept
    {
      return all_above_least<SimdReal>(x);
    }

   private:
    friend class Locator;
    template <class T>
    auto all_above_least(const Eigen::Matrix<T, D, 1, Eigen::DontAlign>& x) const noexcept
    {
      const auto share = [&](std::size_t a) {
        T sum = a == 0 ? 1 : 0;
        for (int d = 0; d < D; ++d)
          sum += slope[a][d] * (x[d] - origin[d]);
        return sum;
      };
      auto inside = share(0) > least;  // false for NaN
      for (std::size_t a = 1; a <= D; ++a)
        inside = inside && share(a) > least;
      return inside;
    }
  };
  Probe probe(const Mesh<D>& mesh, Index c) const noexcept
  {
    return {mesh.node(mesh.cell(c)[0]), mesh.gradients(c), margin_ / mesh.altitude(c)};
  }

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
