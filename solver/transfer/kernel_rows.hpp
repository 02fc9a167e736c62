#pragma once
// Data of the transfer of one kernel for a whole run: the kernel, the rows of blocks, and the data between these and the nodes.
#include <type_traits>

#include "kernels/kernel.hpp"
#include "solver/halo/halo.hpp"
#include "solver/transfer/direct_transfer.hpp"
#include "solver/transfer/projected_transfer.hpp"

namespace talus {

/// Exchanges of the values of nodes that other ranks own.
struct GhostNodes {
  HaloExchange sums;    ///< sums on linear shape functions that own nodes need
  HaloExchange motion;  ///< motion of nodes, or of projected nodes, that own particles use
  HaloExchange felt;    ///< accelerations, for kernels with node operators
};

template <int D, Kernel<D> K>
struct KernelRows {
  static constexpr bool projects = HasNodeOperators<K, D>;
  /// The transfer within a cell; particles add to its `Sum` and read its `Motion`.
  using Through = std::conditional_t<projects, ProjectedTransfer<D, K>, DirectTransfer<D, K>>;
  using Sum = typename Through::Sum;
  using Motion = typename Through::Motion;

  K kernel;
  BlockRows<D, Sum> blocks;
  Halo<Sum> halo;
  GhostNodes ghosts;
  ProjectedNodes<D> projected;          ///< used if the kernel has node operators
  std::vector<NodeMotion<D>> remapped;  ///< MUSL: remapped velocity in `v`, velocity of the step in `change`

  KernelRows(const Mesh<D>& mesh, const Options<K>& options)
      : kernel(make_kernel<K>(mesh, options)),
        blocks(make_block_rows<Sum>(mesh, [&](Index c) { return kernel.stencil(mesh, c); })),
        halo(blocks.size())
  {
    if constexpr (projects) {
      projected.sum.resize(static_cast<std::size_t>(mesh.n_nodes()));
      projected.motion.resize(projected.sum.size());
    }
  }

  /// The motion that particles read.
  const std::vector<Motion>& motion(const Nodes<D>& nodes) const noexcept
  {
    if constexpr (projects)
      return projected.motion;
    else
      return nodes.motion;
  }
};

}  // namespace talus
