#pragma once
// Adjacency of cells and nodes: order along a space-filling curve, neighbours across facets, cells and nodes around a node.
#include <optional>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"

namespace talus {

/// The cells sorted along a Hilbert curve through their centroids (equal positions by number), so that every range is compact.
template <int D>
std::vector<Index> hilbert_order(std::span<const Vec<D>> nodes, std::span<const std::array<Index, D + 1>> cells);

/// The cells at each node, ascending.
template <int D>
Csr cells_at_nodes(std::span<const std::array<Index, D + 1>> cells, Index n_nodes);

/// The nodes of the chosen cells, ascending.
template <int D>
std::vector<Index> nodes_in_use(std::span<const std::array<Index, D + 1>> cells, std::span<const Index> chosen, Index n_nodes);

template <int D>
struct FacetMatch {
  std::vector<std::array<Index, D + 1>> neighbours;  ///< cell across the facet opposite each local node, or `none`
  std::optional<std::array<Facet, 3>> crowded;       ///< a facet of more than two cells; `neighbours` is then incomplete
};
template <int D>
FacetMatch<D> match_facets(std::span<const std::array<Index, D + 1>> cells, const Csr& cells_of_node);

/// The nodes that share a cell with each node, including itself, ascending.
template <int D>
Csr nodes_around(std::span<const std::array<Index, D + 1>> cells, const Csr& cells_of_node);

/// Whether both lists contain the same nodes.
template <std::size_t N>
bool same_nodes(std::array<Index, N> a, std::array<Index, N> b)
{
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  return a == b;
}

}  // namespace talus
