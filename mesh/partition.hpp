#pragma once
// Distribution of blocks of cells among ranks, with equal work and short borders.
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/blocks.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// One particle costs as much as this number of cells without particles.
inline constexpr std::int64_t cells_per_particle = 16;

/// The rank of each block, 0 .. parts-1.  `weight_of_block` counts particles; cells have a small cost too, so that empty space is
/// distributed as well.  Chooses the best of three: ranges along the curve of the cells, and the two methods of METIS on the graph of
/// blocks, which minimise the facets between ranks; only the first if ranks have few full blocks each.  The result is reproducible.  Some
/// ranks may get nothing (if there are more ranks than blocks), see imbalance().  Throws std::invalid_argument for less than one part and
/// for weights that are negative or not one per block, EnvironmentError if METIS fails.  Not thread-safe: METIS sets the random numbers of
/// the C library.
template <int D>
std::vector<int> partition(const Mesh<D>& mesh, std::span<const std::int64_t> weight_of_block, int parts);

/// The cost of a step in each block, from its particles and cells, which partition() distributes.
std::vector<std::int64_t> costs_of_blocks(std::span<const std::int64_t> weight_of_block, Index n_cells);

/// A bound of the imbalance of the result of partition() for these costs.  Needs no mesh.
Real imbalance_in_reach(std::span<const std::int64_t> cost_of_block, int parts);

/// The largest load of a rank over the mean load: 1 is even, `parts` means that everything is on one rank.  1 if there is no load.
Real imbalance(std::span<const std::int64_t> weight_of_block, std::span<const int> rank_of_block, int parts);

}  // namespace talus
