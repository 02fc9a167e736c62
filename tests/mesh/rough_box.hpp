#pragma once
// Boxes of a few hundred or thousand irregular cells with groups of every kind, some of them inside.
#include <algorithm>

#include "mesh/generate/generate.hpp"

namespace talus {

/// 4 n^2 triangles or 12 n^3 tetrahedra.  Besides the sides and `all` of box(): the facet set `some_facets`, inside and on the boundary,
/// the node set `some_nodes` and the cell set `half`.
template <int D>
MeshData<D> rough_box(Index n)
{
  MeshData<D> data = [&] {
    if constexpr (D == 2)
      return jittered(box(Vec<2>(0, 0), Vec<2>(2, 1), {2 * n, n}, Diagonals::random), 0.3, 5, BoundaryNodes::slide);
    else
      return jittered(box<3>({0, 0, 0}, {2, 1, 1}, {2 * n, n, n}), 0.3, 5, BoundaryNodes::slide);
  }();
  const auto n_cells = static_cast<Index>(data.cells.size());
  for (Index c = 0; c < n_cells; c += 2) {
    data.cell_sets["half"].push_back(c);
    std::array<Index, D> facet;
    std::copy_n(data.cells[static_cast<std::size_t>(c)].begin(), D, facet.begin());
    data.facet_sets["some_facets"].push_back(facet);
  }
  for (Index i = 0; i < static_cast<Index>(data.nodes.size()); i += 3)
    data.node_sets["some_nodes"].push_back(i);
  return data;
}

template <int N>
struct Dimension {
  static constexpr int value = N;
};

}  // namespace talus
