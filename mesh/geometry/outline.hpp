#pragma once
// Which edges show the shape of a mesh: for pictures and pages.
#include <array>
#include <span>
#include <vector>

#include "core/types.hpp"

namespace talus {

using Edge = std::array<Index, 2>;  ///< two nodes, the lower number first

struct MeshEdges {
  std::vector<Edge> outline;  ///< the boundary in 2-D; of the boundary in 3-D where two facets meet at more than 30 degrees
  std::vector<Edge> all;      ///< of every cell in 2-D, of every boundary facet in 3-D
};

/// Of the cells of a mesh in `dimension`, which have dimension + 1 `corners` each; `nodes` has 3 numbers a node.  Both lists ascend.
MeshEdges edges_of(int dimension, std::span<const Real> nodes, std::span<const Index> corners);

/// Mean over the nodes of the mean length of the edges at each [m], as Mesh::node_size has it; arguments as above.
Real mean_node_size(int dimension, std::span<const Real> nodes, std::span<const Index> corners);

}  // namespace talus
