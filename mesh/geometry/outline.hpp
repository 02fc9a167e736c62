#pragma once
// Edges that show the shape of a mesh, for pictures and reports.
#include <array>
#include <span>
#include <vector>

#include "core/types.hpp"

namespace talus {

using Edge = std::array<Index, 2>;  ///< two nodes, the lower number first

struct MeshEdges {
  std::vector<Edge> outline;  ///< 2-D: the boundary; 3-D: boundary edges where two facets meet at more than 30 degrees
  std::vector<Edge> all;      ///< 2-D: edges of every cell; 3-D: edges of every boundary facet
};

/// The edges of the cells of a mesh; each cell has dimension + 1 `corners`, `nodes` has 3 numbers per node.  Both lists ascend.
MeshEdges edges_of(int dimension, std::span<const Real> nodes, std::span<const Index> corners);

/// The mean over the nodes of the mean length of the edges at each [m], as in Mesh::node_size.  Arguments as of edges_of().
Real mean_node_size(int dimension, std::span<const Real> nodes, std::span<const Index> corners);

}  // namespace talus
