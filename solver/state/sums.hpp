#pragma once
// Sums that do not depend on the distribution of blocks among threads and ranks: in a fixed order within a block, exact over the blocks.
#include <span>
#include <utility>
#include <vector>

#include "core/parallel/communicator.hpp"
#include "core/parallel/exact_sum.hpp"
#include "core/parallel/threads.hpp"
#include "materials/interface/material.hpp"
#include "solver/state/cell_order.hpp"
#include "solver/state/ledger.hpp"
#include "solver/state/owned_nodes.hpp"

namespace talus {

/// Adds part(i) for all i in [0, n); the parts are computed in parallel.
template <class T, class F>
void add_parts(Index n, ExactSums<T>& sum, F&& part)
{
  static thread_local std::vector<T> buffer;
  buffer.resize(static_cast<std::size_t>(n));
  std::vector<T>& parts = buffer;  // a name that the threads below can share
  parallel_for(n, [&](Index i) { parts[static_cast<std::size_t>(i)] = part(i); });
  for (const T& one : parts)
    sum.add(one);
}

/// Adds f(i) for all i in the ranges; each range is summed in ascending order.
template <class T, class F>
void add_ranges(std::span<const IndexRange> ranges, ExactSums<T>& sum, F&& f)
{
  add_parts(static_cast<Index>(ranges.size()), sum, [&](Index r) {
    T part{};
    for (Index i = ranges[static_cast<std::size_t>(r)].begin; i < ranges[static_cast<std::size_t>(r)].end; ++i)
      part += f(i);
    return part;
  });
}

/// Adds f(row) for the particles of bodies [first, last); those of one body in one block are summed in the order of cells and ids.
template <class T, class F>
void add_particles(const CellOrder& order, std::pair<Index, Index> bodies, ExactSums<T>& sum, F&& f)
{
  add_parts((bodies.second - bodies.first) * order.blocks, sum, [&](Index k) {
    T part{};
    for (const Index row : order.rows(order.key(bodies.first, 0) + static_cast<std::size_t>(k)))
      part += f(row);
    return part;
  });
}
template <class T, class F>
void add_particles(const CellOrder& order, ExactSums<T>& sum, F&& f)
{
  if (order.blocks > 0)
    add_particles(order, {0, static_cast<Index>(order.keys()) / order.blocks}, sum, f);
}

/// The sum over the particles of all ranks.  Collective.
template <class T, class F>
T sum_particles(const CellOrder& order, Communicator& ranks, F&& f)
{
  ExactSums<T> sum;
  add_particles(order, sum, f);
  ranks.sum(sum);
  return sum.value();
}

/// The totals over all ranks.  Collective.
template <int D>
Totals<D> totals(const Particles<D>& particles, const CellOrder& order, Communicator& ranks)
{
  return sum_particles<Totals<D>>(order, ranks, [&](Index row) { return totals_of(particles, static_cast<std::size_t>(row)); });
}

}  // namespace talus
