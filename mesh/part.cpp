#include "mesh/part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/parallel/threads.hpp"
#include "mesh/connectivity.hpp"

namespace talus {

namespace {

/// Appends the cells of a block of a mesh with `n_cells` cells.
void add_cells(Index block, Index n_cells, std::vector<Index>& cells)
{
  for (Index c = block * block_cells; c < n_cells && c / block_cells == block; ++c)
    cells.push_back(c);
}

/// The distance of each node from the vertices of the blocks of a rank, in rings of nodes, up to `farthest`.
template <int D>
std::vector<int> rings_from(const Mesh<D>& mesh, std::span<const int> rank_of_block, int rank, int farthest)
{
  std::vector<int> distance(static_cast<std::size_t>(mesh.n_nodes()), out_of_reach);
  std::vector<Index> own, next;
  for (Index b = 0; b < static_cast<Index>(rank_of_block.size()); ++b)
    if (rank_of_block[b] == rank)
      add_cells(b, mesh.n_cells(), own);
  std::vector<Index> reached = nodes_in_use<D>(mesh.cells(), own, mesh.n_nodes());
  for (const Index n : reached)
    distance[n] = 0;
  // Particles pass through cuts, and a node and its twin act on each other: both are as far away.
  std::vector<Index> twin(mesh.cuts().pairs.empty() ? 0 : static_cast<std::size_t>(mesh.n_nodes()), none);
  for (const NodePair<D>& pair : mesh.cuts().pairs)
    twin[pair.first] = pair.second, twin[pair.second] = pair.first;
  const auto add_twins = [&](std::vector<Index>& nodes, int ring) {
    for (std::size_t i = 0, count = twin.empty() ? 0 : nodes.size(); i < count; ++i)
      if (const Index n = twin[nodes[i]]; n != none && distance[n] == out_of_reach) {
        distance[n] = ring;
        nodes.push_back(n);
      }
  };
  add_twins(reached, 0);
  for (int ring = 1; ring <= farthest && !reached.empty(); ++ring) {
    next.clear();
    for (const Index n : reached)
      for (const Index m : mesh.ring_of_node()[n])
        if (distance[m] == out_of_reach) {
          distance[m] = ring;
          next.push_back(m);
        }
    add_twins(next, ring);
    std::swap(reached, next);
  }
  return distance;
}

/// The index of a number in an ascending list, or `none`.
Index place_in(std::span<const Index> list, Index number) noexcept
{
  const auto found = std::ranges::lower_bound(list, number);
  return found != list.end() && *found == number ? static_cast<Index>(found - list.begin()) : none;
}

}  // namespace

Index Subdomain::local_cell(Index whole) const noexcept
{
  const Index b = place_in(block, whole / block_cells);
  return b == none ? none : b * block_cells + whole % block_cells;
}

Index Subdomain::local_node(Index whole) const noexcept { return place_in(node, whole); }

template <int D>
Part<D> cut(const Mesh<D>& whole, std::span<const int> rank_of_block, int rank, int rings)
{
  const Index n_blocks = blocks_of(whole.n_cells());
  if (rank_of_block.size() != static_cast<std::size_t>(n_blocks))
    throw std::invalid_argument(fmt::format("{} ranks for {} blocks of cells", rank_of_block.size(), n_blocks));

  // A cell in ring k has a vertex at distance k-1 or less.
  const std::vector<int> distance = rings_from(whole, rank_of_block, rank, rings - 1);
  std::vector<std::uint8_t> wanted(rank_of_block.size());
  parallel_for(n_blocks, [&](Index b) {
    const auto is_near = [&](const auto& cell) { return std::ranges::any_of(cell, [&](Index n) { return distance[n] < rings; }); };
    const auto cells = whole.cells().subspan(b * block_cells, std::min(block_cells, whole.n_cells() - b * block_cells));
    wanted[b] = rank_of_block[b] == rank || std::ranges::any_of(cells, is_near);
  });

  std::vector<Index> blocks, cells;
  std::vector<int> ranks;
  for (Index b = 0; b < n_blocks; ++b)
    if (wanted[b] != 0) {
      blocks.push_back(b);
      ranks.push_back(rank_of_block[b]);
      add_cells(b, whole.n_cells(), cells);
    }
  std::vector<Index> nodes = nodes_in_use<D>(whole.cells(), cells, whole.n_nodes());
  std::vector<int> owners;
  for (const Index n : nodes)
    owners.push_back(rank_of_block[whole.cells_of_node()[n].front() / block_cells]);
  return {Mesh<D>(whole, cells),
          {std::move(blocks),
           std::move(ranks),
           std::move(nodes),
           std::move(owners),
           whole.n_cells(),
           whole.n_nodes(),
           rank,
           {rank_of_block.begin(), rank_of_block.end()}}};
}

template <int D>
std::vector<int> rings_from_own(const Part<D>& part)
{
  return rings_from(part.mesh, part.subdomain.rank_of_block, part.subdomain.rank, out_of_reach - 1);
}

template Part<2> cut<2>(const Mesh<2>&, std::span<const int>, int, int);
template Part<3> cut<3>(const Mesh<3>&, std::span<const int>, int, int);
template std::vector<int> rings_from_own<2>(const Part<2>&);
template std::vector<int> rings_from_own<3>(const Part<3>&);

}  // namespace talus
