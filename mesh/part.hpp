#pragma once
// What one rank holds of a mesh: its own blocks of cells, and as many around them as its sums reach.
#include <limits>
#include <span>
#include <vector>

#include "mesh/blocks.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// Whose the blocks and nodes of a mesh are that one of several ranks holds a part of, and what number they have in the whole.  A rank that is
/// alone needs none of it: all lists are empty.
struct Subdomain {
  std::vector<Index> block;                ///< local block -> block of the whole mesh, ascending
  std::vector<int> rank_of_block;          ///< of each local block
  std::vector<Index> node;                 ///< local node -> node of the whole mesh, ascending
  std::vector<int> rank_of_node;           ///< of each local node: the rank of the lowest cell that the whole mesh has around it
  Index whole_cells = 0, whole_nodes = 0;  ///< how many the whole mesh has
  int rank = 0;
  std::vector<int> rank_of_whole_block;  ///< of all blocks of the whole mesh

  bool alone() const noexcept { return whole_cells == 0; }
  bool owns_block(Index local) const noexcept { return rank_of_block[static_cast<std::size_t>(local)] == rank; }
  bool owns_cell(Index local) const noexcept { return owns_block(local / block_cells); }
  bool owns_node(Index local) const noexcept { return rank_of_node[static_cast<std::size_t>(local)] == rank; }

  Index whole_cell(Index local) const noexcept
  {
    return block[static_cast<std::size_t>(local / block_cells)] * block_cells + local % block_cells;
  }
  Index local_cell(Index whole) const noexcept;  ///< `none` if the cell is not held
  Index local_node(Index whole) const noexcept;  ///< `none` if the node is not held
};

/// Blocks are held whole and in their order, and only the last one of the whole mesh may be short.  So the local cell c lies in the
/// local block c / block_cells, here as there, and local order of cells, blocks and nodes is that of the whole.
///
/// A rank without blocks of its own holds nothing: no cells, no nodes.
template <int D>
struct Part {
  Mesh<D> mesh;
  Subdomain share;
};

/// Holds the blocks of `rank` and every block with a cell within `rings` rings of one of their cells: ring 1 shares a node with them,
/// ring 2 a node with ring 1.  Linear in the cells of the whole mesh.  Throws std::invalid_argument unless each block has a rank.
template <int D>
Part<D> cut(const Mesh<D>& whole, std::span<const int> rank_of_block, int rank, int rings);

/// A node that no chain of cells held joins to an own cell.
inline constexpr int out_of_reach = std::numeric_limits<int>::max();

/// For each local node how many cells lie between it and the vertices of own cells, which have 0.  Up to the `rings` of the cut this is
/// the distance in the whole mesh; beyond, the way may lead through cells that are not held, and the distance may be too long.  A node
/// less than `rings` away has all its cells here.
template <int D>
std::vector<int> rings_from_own(const Part<D>& part);

}  // namespace talus
