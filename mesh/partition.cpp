#include "mesh/partition.hpp"

#include <fmt/format.h>
#include <metis.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "core/error.hpp"
#include "core/parallel/threads.hpp"

namespace talus {

namespace {

/// The largest total weight: METIS computes with 32-bit integers.
constexpr std::int64_t largest_total = 1 << 30;

/// The imbalance that is accepted: METIS may use it to shorten borders, and particles move anyway.
constexpr Real even_enough = 1.03;

/// METIS is called if the mean load is at least that of so many blocks of the largest cost.  With fewer blocks there is little choice, and
/// METIS prints complaints on the standard output where it has no block for a rank.
constexpr std::int64_t enough_blocks = 4;

/// The blocks as nodes of a graph, with the number of common facets between blocks as weight of edges.
struct BlockGraph {
  std::vector<std::int64_t> cost;
  std::int64_t total = 0;
  std::vector<idx_t> begin{0}, neighbour, facets;  // compressed rows in the types of METIS
  idx_t size() const { return static_cast<idx_t>(cost.size()); }
};

template <int D>
BlockGraph graph_of(const Mesh<D>& mesh, std::span<const std::int64_t> weights)
{
  BlockGraph graph;
  graph.cost = costs_of_blocks(weights, mesh.n_cells());
  graph.total = std::accumulate(graph.cost.begin(), graph.cost.end(), std::int64_t{0});
  std::vector<std::vector<std::pair<Index, idx_t>>> around(graph.cost.size());  // block, number of common facets
  parallel_for(graph.size(), [&](Index b) {
    static thread_local std::vector<Index> across;
    across.clear();
    for (Index c = b * block_cells; c < std::min(mesh.n_cells(), (b + 1) * block_cells); ++c)
      for (const Index other : mesh.neighbours(c))
        if (other != none && other / block_cells != b)
          across.push_back(other / block_cells);
    std::sort(across.begin(), across.end());
    for (const Index other : across) {
      if (around[b].empty() || around[b].back().first != other)
        around[b].emplace_back(other, 0);
      ++around[b].back().second;
    }
  });
  for (const auto& row : around) {
    for (const auto& [other, shared] : row) {
      graph.neighbour.push_back(other);
      graph.facets.push_back(shared);
    }
    graph.begin.push_back(static_cast<idx_t>(graph.neighbour.size()));
  }
  return graph;
}

/// Ranges of consecutive blocks with loads as equal as possible.
std::vector<int> along_the_curve(std::span<const std::int64_t> cost_of_block, int parts)
{
  const std::int64_t total = std::accumulate(cost_of_block.begin(), cost_of_block.end(), std::int64_t{0});
  std::vector<int> rank;
  std::int64_t before = 0;
  for (const std::int64_t cost : cost_of_block) {
    rank.push_back(static_cast<int>((2 * before + cost) * parts / (2 * total)));  // by the middle of the block
    before += cost;
  }
  return rank;
}

std::vector<int> by_metis(BlockGraph& graph, int parts, decltype(METIS_PartGraphKway)& method)
{
  std::vector<idx_t> weight(graph.cost.begin(), graph.cost.end()), rank(graph.cost.size());
  std::array<idx_t, METIS_NOPTIONS> options;
  METIS_SetDefaultOptions(options.data());
  options[METIS_OPTION_SEED] = 1;
  idx_t n = graph.size(), constraints = 1, n_parts = parts, cut = 0;
  const int status = method(&n, &constraints, graph.begin.data(), graph.neighbour.data(), weight.data(), nullptr, graph.facets.data(),
                            &n_parts, nullptr, nullptr, options.data(), &cut, rank.data());
  if (status != METIS_OK)
    throw EnvironmentError(fmt::format("METIS cannot share {} blocks of cells out among {} ranks ({})", n, parts,
                                       status == METIS_ERROR_MEMORY ? "out of memory" : fmt::format("its status is {}", status)));
  return {rank.begin(), rank.end()};
}

/// The number of facets between blocks of different ranks, each counted from both sides.
std::int64_t cut_of(const BlockGraph& graph, std::span<const int> rank)
{
  std::int64_t cut = 0;
  for (idx_t b = 0; b < graph.size(); ++b)
    for (idx_t i = graph.begin[b]; i < graph.begin[b + 1]; ++i)
      if (rank[b] != rank[graph.neighbour[i]])
        cut += graph.facets[i];
  return cut;
}

}  // namespace

template <int D>
std::vector<int> partition(const Mesh<D>& mesh, std::span<const std::int64_t> weight_of_block, int parts)
{
  const Index n_blocks = blocks_of(mesh.n_cells());
  if (parts < 1)
    throw std::invalid_argument(fmt::format("a mesh cannot be shared out among {} ranks", parts));
  if (weight_of_block.size() != static_cast<std::size_t>(n_blocks))
    throw std::invalid_argument(fmt::format("{} weights for {} blocks of cells", weight_of_block.size(), n_blocks));
  for (const std::int64_t weight : weight_of_block)
    if (weight < 0)
      throw std::invalid_argument(fmt::format("a block of cells cannot weigh {}", weight));

  std::vector<int> best(weight_of_block.size(), 0);
  if (parts == 1)
    return best;
  if (parts >= n_blocks) {
    std::iota(best.begin(), best.end(), 0);
    return best;
  }
  BlockGraph graph = graph_of(mesh, weight_of_block);
  const auto badness = [&](const std::vector<int>& rank) {
    return std::pair(std::max(even_enough, imbalance(graph.cost, rank, parts)), cut_of(graph, rank));
  };
  best = along_the_curve(graph.cost, parts);
  if (enough_blocks * parts * *std::max_element(graph.cost.begin(), graph.cost.end()) > graph.total)
    return best;
  for (const auto method : {&METIS_PartGraphRecursive, &METIS_PartGraphKway})
    if (auto rank = by_metis(graph, parts, *method); badness(rank) < badness(best))
      best = std::move(rank);
  return best;
}

std::vector<std::int64_t> costs_of_blocks(std::span<const std::int64_t> weight_of_block, Index n_cells)
{
  std::vector<std::int64_t> cost(weight_of_block.size());
  std::int64_t total = 0;
  for (std::size_t b = 0; b < cost.size(); ++b) {
    const std::int64_t first = static_cast<std::int64_t>(b) * block_cells;
    total += cost[b] = cells_per_particle * weight_of_block[b] + std::min<std::int64_t>(block_cells, n_cells - first);
  }
  const std::int64_t unit = total / largest_total + 1;
  for (std::int64_t& c : cost)
    c = std::max<std::int64_t>(c / unit, 1);
  return cost;
}

Real imbalance_in_reach(std::span<const std::int64_t> cost_of_block, int parts)
{
  return std::max(even_enough, imbalance(cost_of_block, along_the_curve(cost_of_block, parts), parts));
}

Real imbalance(std::span<const std::int64_t> weight_of_block, std::span<const int> rank_of_block, int parts)
{
  std::vector<std::int64_t> load(static_cast<std::size_t>(parts), 0);
  for (std::size_t b = 0; b < weight_of_block.size(); ++b)
    load[rank_of_block[b]] += weight_of_block[b];
  const auto total = static_cast<Real>(std::accumulate(load.begin(), load.end(), std::int64_t{0}));
  return total > 0 ? static_cast<Real>(*std::max_element(load.begin(), load.end())) * parts / total : 1;
}

template std::vector<int> partition<2>(const Mesh<2>&, std::span<const std::int64_t>, int);
template std::vector<int> partition<3>(const Mesh<3>&, std::span<const std::int64_t>, int);

}  // namespace talus
