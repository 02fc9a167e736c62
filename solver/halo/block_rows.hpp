#pragma once
// Rows of blocks of cells: separate sums for the particles of each block.
#include "core/parallel/threads.hpp"
#include "mesh/mesh.hpp"
#include "solver/state/cell_order.hpp"
#include "solver/state/nodes.hpp"

namespace talus {

/// Static tables and the rows.  A node that several blocks reach has a row in each of them; `assemble` (halo.hpp) adds the rows in
/// ascending order.  So no two threads write the same row, and sums do not depend on the number of threads.
template <int D, class Sum = NodeSum<D>>
struct BlockRows {
  std::vector<Index> begin;         ///< first row of each block; one more at the end
  std::vector<std::uint16_t> slot;  ///< row within the block for every stencil entry of every cell
  std::vector<Index> slot_begin;    ///< first entry in `slot` of each cell
  Csr rows_of_node;                 ///< rows of each node, ascending
  std::vector<Index> block_of_row;
  std::vector<std::uint8_t> occupied;  ///< whether each block contains particles in this step
  SparseRows<Sum> row;

  Index size() const noexcept { return static_cast<Index>(occupied.size()); }
  std::span<Sum> rows(Index b) noexcept
  {
    const auto first = static_cast<std::size_t>(begin[static_cast<std::size_t>(b)]),
               last = static_cast<std::size_t>(begin[static_cast<std::size_t>(b) + 1]);
    return std::span(row).subspan(first, last - first);
  }
  std::span<const std::uint16_t> slots(Index cell) const noexcept
  {
    const auto first = static_cast<std::size_t>(slot_begin[static_cast<std::size_t>(cell)]),
               last = static_cast<std::size_t>(slot_begin[static_cast<std::size_t>(cell) + 1]);
    return std::span(slot).subspan(first, last - first);
  }
};

/// The tables for stencils on a mesh; stencil(cell) returns the nodes.
template <class Sum, int D, class Stencil>
BlockRows<D, Sum> make_block_rows(const Mesh<D>& mesh, Stencil&& stencil)
{
  const auto z = [](Index i) { return static_cast<std::size_t>(i); };
  BlockRows<D, Sum> blocks;
  const Index n_blocks = blocks_of(mesh.n_cells());
  blocks.occupied.assign(z(n_blocks), 0);
  blocks.begin.assign(z(n_blocks) + 1, 0);
  blocks.slot_begin.assign(z(mesh.n_cells()) + 1, 0);
  for (Index c = 0; c < mesh.n_cells(); ++c)
    blocks.slot_begin[z(c) + 1] = blocks.slot_begin[z(c)] + static_cast<Index>(stencil(c).size());
  blocks.slot.resize(z(blocks.slot_begin.back()));

  std::vector<Index> row_of_node(z(mesh.n_nodes()), none), node_of_row;  // numbers rows by first use
  for (Index b = 0; b < n_blocks; ++b) {
    const auto first_row = static_cast<Index>(node_of_row.size());
    const Index last_cell = std::min(mesh.n_cells(), (b + 1) * block_cells);
    for (Index c = b * block_cells; c < last_cell; ++c) {
      Index entry = blocks.slot_begin[z(c)];
      for (const Index n : stencil(c)) {
        if (row_of_node[z(n)] < first_row) {
          row_of_node[z(n)] = static_cast<Index>(node_of_row.size());
          node_of_row.push_back(n);
          blocks.block_of_row.push_back(b);
        }
        blocks.slot[z(entry++)] = static_cast<std::uint16_t>(row_of_node[z(n)] - first_row);
      }
    }
    blocks.begin[z(b) + 1] = static_cast<Index>(node_of_row.size());
  }

  blocks.row.resize(node_of_row.size());
  auto& rows = blocks.rows_of_node;
  rows.begin.assign(z(mesh.n_nodes()) + 1, 0);
  rows.item.resize(node_of_row.size());
  for (const Index n : node_of_row)
    ++rows.begin[z(n) + 1];
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    rows.begin[z(n) + 1] += rows.begin[z(n)];
  std::vector<Index> next(rows.begin.begin(), rows.begin.end() - 1);
  for (std::size_t r = 0; r < node_of_row.size(); ++r)
    rows.item[z(next[z(node_of_row[r])]++)] = static_cast<Index>(r);
  return blocks;
}

}  // namespace talus
