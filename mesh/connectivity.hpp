#pragma once
// From a list of cells to who touches whom: order along a space-filling curve, neighbours across facets, cells and nodes at a node.
#include <optional>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"

namespace talus {

/// The cells sorted along a Hilbert curve through their centroids (equal places: by number), so that every range is compact.
template <int D>
std::vector<Index> hilbert_order(std::span<const Vec<D>> nodes, std::span<const std::array<Index, D + 1>> cells);

/// Cells at each node, ascending.
template <int D>
Csr cells_at_nodes(std::span<const std::array<Index, D + 1>> cells, Index n_nodes);

/// Nodes of the chosen cells, ascending.
template <int D>
std::vector<Index> nodes_in_use(std::span<const std::array<Index, D + 1>> cells, std::span<const Index> chosen, Index n_nodes);

template <int D>
struct FacetMatch {
  std::vector<std::array<Index, D + 1>> neighbours;  ///< cell across the facet opposite each local node, or `none`
  std::optional<std::array<Facet, 3>> crowded;       ///< a facet that more than two cells claim; `neighbours` is then incomplete
};
template <int D>
FacetMatch<D> match_facets(std::span<const std::array<Index, D + 1>> cells, const Csr& cells_of_node);

/// Nodes that share a cell with each node, itself included, ascending.
template <int D>
Csr nodes_around(std::span<const std::array<Index, D + 1>> cells, const Csr& cells_of_node);

/// True if both lists hold the same nodes.
template <std::size_t N>
bool same_nodes(std::array<Index, N> a, std::array<Index, N> b)
{
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  return a == b;
}

}  // namespace talus
