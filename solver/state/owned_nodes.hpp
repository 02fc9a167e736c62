#pragma once
// The nodes that a rank owns; each node of the whole mesh is owned by one rank.
#include <utility>
#include <vector>

#include "mesh/mesh.hpp"
#include "mesh/part.hpp"
#include "solver/state/cell_order.hpp"

namespace talus {

/// The numbers in [begin, end).
struct IndexRange {
  Index begin, end;
};

/// Own nodes.  Nodes are numbered by the first cell that uses them, so the nodes first used by a block are consecutive.
struct OwnNodes {
  std::vector<IndexRange> of_block;  ///< ranges of nodes first used by own blocks, ascending
  std::vector<std::uint8_t> owned;   ///< flag for each node

  bool has(Index node) const noexcept { return owned[static_cast<std::size_t>(node)] != 0; }
};

/// The own nodes of a single rank: all nodes.
template <int D>
OwnNodes all_nodes(const Mesh<D>& mesh)
{
  OwnNodes own{{}, std::vector<std::uint8_t>(static_cast<std::size_t>(mesh.n_nodes()), 1)};
  for (Index n = 0, block = none; n < mesh.n_nodes(); ++n) {
    if (const Index first = mesh.cells_of_node()[n].front() / block_cells; std::exchange(block, first) != first)
      own.of_block.push_back({n, n});
    ++own.of_block.back().end;
  }
  return own;
}

/// The own nodes of one of several ranks.
template <int D>
OwnNodes own_nodes(const Mesh<D>& mesh, const Subdomain& subdomain)
{
  OwnNodes all = all_nodes(mesh), own{{}, std::move(all.owned)};
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    own.owned[static_cast<std::size_t>(n)] = subdomain.owns_node(n) ? 1 : 0;
  for (const IndexRange& range : all.of_block)
    if (own.has(range.begin))
      own.of_block.push_back(range);
  return own;
}

}  // namespace talus
