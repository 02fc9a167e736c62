#pragma once
// Which rank gets which blocks of cells: even shares of work, short borders between them.
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/blocks.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// One particle costs as much as so many cells without any.
inline constexpr std::int64_t cells_per_particle = 16;

/// The rank of each block, 0 .. parts-1.  `weight_of_block` counts particles; the cells themselves cost a little too, so that empty
/// space is shared out as well.  Best of three: ranges along the curve of the cells, and the two methods of METIS on the graph of
/// blocks, which count the facets between ranks; the first alone if ranks get hardly more than a few full blocks each.  The same
/// answer every time.  Ranks may get nothing (they do if there are more of them than blocks), see imbalance().
///
/// Throws std::invalid_argument for less than one part and weights that are negative or not one per block, EnvironmentError if METIS
/// fails.  One call at a time: METIS sets the random numbers of the C library.
template <int D>
std::vector<int> partition(const Mesh<D>& mesh, std::span<const std::int64_t> weight_of_block, int parts);

/// What a step costs in each block, by its particles and its cells: what partition() shares out.
std::vector<std::int64_t> costs_of_blocks(std::span<const std::int64_t> weight_of_block, Index n_cells);

/// An imbalance of these costs that partition() does not exceed.  Needs no mesh.
Real imbalance_in_reach(std::span<const std::int64_t> cost_of_block, int parts);

/// Largest load of a rank over the mean of all of them: 1 is even, `parts` is everything on one.  1 if there is no load at all.
Real imbalance(std::span<const std::int64_t> weight_of_block, std::span<const int> rank_of_block, int parts);

}  // namespace talus
