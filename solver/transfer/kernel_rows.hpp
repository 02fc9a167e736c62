#pragma once
// What the transfer of one kernel keeps as long as a run: the kernel, the rows of blocks, and what stands between these and the nodes.
#include <type_traits>

#include "kernels/kernel.hpp"
#include "solver/halo/halo.hpp"
#include "solver/transfer/direct_transfer.hpp"
#include "solver/transfer/projected_transfer.hpp"

namespace talus {

/// Exchange of what is to be known here of nodes that other ranks own.
struct GhostNodes {
  HaloExchange sums;    ///< of linear shape functions, where unknowns of own nodes collect from them
  HaloExchange motion;  ///< that own particles read, or the projected nodes that they read
  HaloExchange felt;    ///< accelerations, where operators stand between nodes and particles
};

template <int D, Kernel<D> K>
struct KernelRows {
  static constexpr bool projects = HasNodeOperators<K, D>;
  /// Transfer within a cell; what particles deposit is its `Sum`, what they read its `Motion`.
  using Through = std::conditional_t<projects, ProjectedTransfer<D, K>, DirectTransfer<D, K>>;
  using Sum = typename Through::Sum;
  using Motion = typename Through::Motion;

  K kernel;
  BlockRows<D, Sum> blocks;
  Halo<Sum> halo;
  GhostNodes ghosts;
  ProjectedNodes<D> projected;          ///< if the kernel has node operators
  std::vector<NodeMotion<D>> remapped;  ///< MUSL: remapped velocity in `v`, the step's own in `change`

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

  /// What particles read.
  const std::vector<Motion>& motion(const Nodes<D>& nodes) const noexcept
  {
    if constexpr (projects)
      return projected.motion;
    else
      return nodes.motion;
  }
};

}  // namespace talus
