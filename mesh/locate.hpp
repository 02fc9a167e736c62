#pragma once
// Which cell holds a point: a walk across facets from a hint, a search in bins when the walk loses its way.
#include <optional>

#include "mesh/mesh.hpp"

namespace talus {

/// Where a point is.  On a facet, edge or node shared by cells the lowest cell number wins, whatever the hint was.
template <int D>
class Locator {
 public:
  explicit Locator(const Mesh<D>& mesh);

  /// Cell of x, or nothing if x is outside the mesh by more than round-off (1e-10 of the cell's size), or not finite.
  /// The usual case, x still inside cell `hint`, costs one barycentric map.  `hint` may be `none`.
  std::optional<Index> operator()(const Mesh<D>& mesh, const Vec<D>& x, Index hint) const noexcept;

  /// The point of the mesh nearest to x and its cell, for x outside: the projection on the nearest boundary facet.
  struct Nearest {
    Vec<D> x;
    Index cell;
    Facet facet;
  };
  Nearest nearest(const Mesh<D>& mesh, const Vec<D>& x) const noexcept;

 private:
  Vec<D> low_, bin_size_;
  std::array<Index, D> bins_{};
  Csr cells_of_bin_, facets_of_bin_;
};

extern template class Locator<2>;
extern template class Locator<3>;

}  // namespace talus
