#pragma once
// The unknowns of a static increment: displacements of the nodes with a motion of their own.
#include <vector>

#include "solver/halo/halo_exchange.hpp"
#include "solver/model/problem.hpp"
#include "solver/state/nodes.hpp"

namespace talus {

template <int D>
struct Unknowns {
  std::vector<Index> node;   ///< own nodes, ascending
  std::vector<Index> row;    ///< by node: its place in `node`; none without unknowns here
  std::vector<Real> number;  ///< by node: 1 + its number among those of all ranks; 0 without a motion of its own
  Real length = 1;           ///< least altitude of the cells around: the unit of the unknowns [m]
  HaloExchange copies;       ///< of values of nodes

  Unknowns() = default;
  /// The active nodes.  Collective.
  Unknowns(const Problem<D>& problem, const Nodes<D>& nodes)
      : row(to_size(problem.mesh.n_nodes()), none), number(to_size(problem.mesh.n_nodes()), 0)
  {
    Communicator& ranks = *problem.ranks;
    Real least = std::numeric_limits<Real>::infinity();
    nodes.in_use.for_each_ascending([&](Index n) {
      if (!problem.own.has(n) || nodes.active[to_size(n)] == 0)
        return;
      row[to_size(n)] = static_cast<Index>(node.size());
      node.push_back(n);
      for (const Index c : problem.mesh.cells_of_node()[n])
        least = std::min(least, problem.mesh.altitude(c));
    });
    length = ranks.min(least);
    std::vector<std::int64_t> counts(to_size(ranks.size()), 0);
    counts[to_size(ranks.rank())] = static_cast<std::int64_t>(node.size());
    ranks.sum(std::span(counts));
    std::int64_t next = 1;
    for (int r = 0; r < ranks.rank(); ++r)
      next += counts[to_size(r)];
    for (const Index n : node)
      number[to_size(n)] = static_cast<Real>(next++);
    if (problem.subdomain.alone())
      return;
    copies = copies_of_nodes(ranks, problem.subdomain, MessageTag::equations, spread_by_rings(problem.mesh, problem.own.owned, rings_held));
    send(number);
  }

  std::size_t size() const noexcept { return node.size() * D; }
  bool has(Index n) const noexcept { return number[to_size(n)] > 0; }
  /// The number of the first unknown of a node among those of all ranks.
  std::int64_t first(Index n) const noexcept { return (static_cast<std::int64_t>(number[to_size(n)]) - 1) * D; }
  /// Sends the values of own nodes to the ranks that hold copies of them.  Collective.
  template <class T>
  void send(std::vector<T>& values)
  {
    copies.send(values, Numbers{});
    copies.take(values, Numbers{});
  }
};

}  // namespace talus
