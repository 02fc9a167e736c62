#pragma once
// Blocks of cells: the unit of parallel work among threads, and of the partition among ranks.
#include "core/types.hpp"

namespace talus {

/// Cells [b * block_cells, (b+1) * block_cells) form block b: near one another in space, because the mesh numbers its cells
/// along a space-filling curve.  Blocks are the unit of parallel work; they depend on the mesh only.
inline constexpr Index block_cells = 128;

/// How many blocks so many cells make; only the last one may be short.
constexpr Index blocks_of(Index n_cells) noexcept { return n_cells / block_cells + (n_cells % block_cells != 0); }

}  // namespace talus
