#pragma once
// The part of a mesh on one rank: its own blocks of cells, and as many around them as its sums need.
#include <limits>
#include <span>
#include <vector>

#include "mesh/blocks.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// The owners of the blocks and nodes in the part of a rank, and their numbers in the whole mesh.  On a single rank all lists are empty.
struct Subdomain {
  std::vector<Index> block;                ///< local block -> block of the whole mesh, ascending
  std::vector<int> rank_of_block;          ///< of each local block
  std::vector<Index> node;                 ///< local node -> node of the whole mesh, ascending
  std::vector<int> rank_of_node;           ///< rank of each local node: that of the lowest cell around the node in the whole mesh
  Index whole_cells = 0, whole_nodes = 0;  ///< numbers of cells and nodes of the whole mesh
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
  Index local_cell(Index whole) const noexcept;  ///< `none` if the part does not contain the cell
  Index local_node(Index whole) const noexcept;  ///< `none` if the part does not contain the node
};

/// The part of a mesh on one rank.  Blocks are complete and in order, and only the last block of the whole mesh may be short.  So the local
/// cell c lies in the local block c / block_cells, as in the whole mesh, and the local order of cells, blocks and nodes is that of the
/// whole.  A rank without own blocks has no cells and no nodes.
template <int D>
struct Part {
  Mesh<D> mesh;
  Subdomain subdomain;
};

/// Holds the blocks of `rank` and every block with a cell within `rings` rings of one of their cells: ring 1 shares a node with them,
/// ring 2 a node with ring 1; a node and its twin at a cut count as one.  Linear in the cells of the whole mesh.  Throws std::invalid_argument unless each block has a rank.
template <int D>
Part<D> cut(const Mesh<D>& whole, std::span<const int> rank_of_block, int rank, int rings);

/// The distance of a node that no chain of cells of the part connects to an own cell.
inline constexpr int out_of_reach = std::numeric_limits<int>::max();

/// For each local node the number of cells between it and the vertices of own cells, which have 0.  Up to the `rings` of the cut this is
/// the distance in the whole mesh; beyond, the shortest way may lead through cells outside the part, and the distance may be too long.  The
/// part contains all cells of a node less than `rings` away.
template <int D>
std::vector<int> rings_from_own(const Part<D>& part);

}  // namespace talus
