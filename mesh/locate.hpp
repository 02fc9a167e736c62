#pragma once
// Which cell holds a point: a walk across facets from a hint, a search in a tree of boxes when the walk loses its way.
#include <optional>

#include "core/simd.hpp"
#include "mesh/geometry/box_tree.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// How far outside a cell a point may be and still count as inside: round-off, relative to the longest edge of the cell.
inline constexpr Real location_tolerance = 1e-10;

/// Where a point is.  On a facet, edge or node shared by cells the lowest cell number wins, whatever the hint was.
///
/// In a part of a mesh (see Mesh) a point is where it is in the whole, if the cells that share a node with its cell there are held too;
/// a point in a cell that is not held is outside.
template <int D>
class Locator {
 public:
  explicit Locator(const Mesh<D>& mesh);

  /// Cell of x, or nothing if x is outside the mesh by more than round-off (1e-10 of the cell's size), or not finite.
  /// The usual case, x still inside cell `hint`, costs one barycentric map.  `hint` may be `none`.
  std::optional<Index> operator()(const Mesh<D>& mesh, const Vec<D>& x, Index hint) const noexcept;

  /// One cell opened for many points: most particles are still deep inside the cell they were in.
  struct Probe {
    const Vec<D>& origin;
    const std::array<Vec<D>, D + 1>& slope;  ///< gradients of the barycentric coordinates [1/m]
    Real least;                              ///< a point with all coordinates above this lies in no other cell
    bool deep(const Vec<D>& x) const noexcept { return all_above_least<Real>(x); }
    /// Of several points at once.
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

  Real margin_;  // a point this deep [m] inside a cell is within the tolerance of no other cell of the whole mesh
  BoxTree<D> cells_, facets_;
};

extern template class Locator<2>;
extern template class Locator<3>;

}  // namespace talus
