#pragma once
// The values of nodes and cells of other ranks that the rows of a velocity field need.
#include <algorithm>

#include "solver/model/model.hpp"
#include "solver/transfer/kernel_rows.hpp"

namespace talus {

/// Makes the exchanges of the rows of a velocity field with other ranks.  Collective.
template <int D, Kernel<D> K>
void join_ranks(const Problem<D>& problem, KernelRows<D, K>& of)
{
  Communicator& ranks = *problem.ranks;
  of.halo = Halo(ranks, problem.mesh, problem.subdomain, of.blocks);
  of.surfaces = {};  // whose exchange is that of another part
  const auto copy = [&](MessageTag topic, const std::vector<std::uint8_t>& wanted) {
    return copies_of_nodes(ranks, problem.subdomain, topic, wanted);
  };
  const std::vector<std::uint8_t> read = nodes_read(problem.subdomain, of.blocks);
  if constexpr (KernelRows<D, K>::projects) {
    const auto both = [](std::vector<std::uint8_t> marked, const std::vector<std::uint8_t>& others) {
      for (std::size_t n = 0; n < marked.size(); ++n)
        marked[n] |= others[n];
      return marked;
    };
    const auto around_own = [&](int rings) { return spread_by_rings(problem.mesh, problem.own.owned, rings); };
    const std::vector<std::uint8_t> moving = spread_by_rings(problem.mesh, read, 1);
    of.ghosts.sums = copy(MessageTag::sums, both(around_own(1), read));
    of.ghosts.motion = copy(MessageTag::motion, moving);
    of.ghosts.felt = copy(MessageTag::felt, around_own(2));
    if (of.kernel.extends_surfaces())
      of.ghosts.near = copy(MessageTag::near, both(around_own(Extension<D>::rings), moving));
    of.ghosts.cells = copies_of_cells(ranks, problem.subdomain, MessageTag::cells, problem.mesh.n_cells());
    of.projected.find_late(problem.mesh, problem.own);
  } else {
    of.ghosts.motion = copy(MessageTag::motion, read);
  }
}

}  // namespace talus
