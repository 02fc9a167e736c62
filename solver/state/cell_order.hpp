#pragma once
// The particles of each cell: rows sorted by body, cell and id, and the beginning of each block of cells.
#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/particles.hpp"
#include "mesh/blocks.hpp"

namespace talus {

/// The order of particles.  Within a cell particles are sorted by id, so nodal sums depend on the state only, not on its history.
struct CellOrder {
  std::vector<Index> row;    ///< particle rows sorted by (body, cell, id)
  std::vector<Index> first;  ///< first position in `row` for each (body * blocks + block); one more at the end
  Index blocks = 0;

  /// The index in `first` for the particles of a body in a block.
  std::size_t key(Index body, Index block) const noexcept
  {
    return static_cast<std::size_t>(body) * static_cast<std::size_t>(blocks) + static_cast<std::size_t>(block);
  }
  std::size_t keys() const noexcept { return first.size() - 1; }
  std::span<const Index> rows(std::size_t at) const noexcept
  {
    return std::span(row).subspan(static_cast<std::size_t>(first[at]), static_cast<std::size_t>(first[at + 1] - first[at]));
  }

  std::vector<Index> count;  ///< buffer of the sort
};

/// Sorts by `cell` and `id`; `order` keeps its buffers.  Linear in particles and cells.
void sort_by_cell(std::span<const Index> cell, std::span<const std::int64_t> id, std::span<const Body> bodies, Index n_cells,
                  CellOrder& order);

}  // namespace talus
