#pragma once
// Data of the transfer of one kernel for a velocity field: the rows of blocks, and the data between these and the nodes.
#include <span>
#include <type_traits>
#include <vector>

#include "kernels/kernel.hpp"
#include "solver/halo/halo.hpp"
#include "solver/transfer/cell_moments.hpp"
#include "solver/transfer/extension.hpp"
#include "solver/transfer/interfaces.hpp"
#include "solver/transfer/kept_weights.hpp"
#include "solver/transfer/projected_nodes.hpp"
#include "solver/transfer/surface_rows.hpp"

namespace talus {

/// Exchanges of the values of nodes that other ranks own.
struct GhostNodes {
  HaloExchange sums;    ///< sums on linear shape functions that own nodes need
  HaloExchange motion;  ///< motion of nodes, or of projected nodes, that own particles use
  HaloExchange felt;    ///< accelerations, for kernels with node operators
  HaloExchange near;    ///< values of the sources of own nodes, and of nodes that own particles use, where surfaces are extended
  HaloExchange cells;   ///< sums of cells over groups of bodies, for kernels with node operators
};

template <int D, Kernel<D> K>
struct KernelRows {
  static constexpr bool projects = HasNodeOperators<K, D>;
  /// What the particles of a block add to.
  using Sum = std::conditional_t<projects, ProjectedNodeSum<D>, NodeSum<D>>;

  const K& kernel;
  std::size_t field;  ///< its number
  BlockRows<D, Sum> blocks;
  Halo<Sum> halo;
  GhostNodes ghosts;
  SurfaceRows<D> surfaces;             ///< loads on surfaces that cut cells
  SparseRows<CellMoments<D>> moments;  ///< MUSL, if weights are barycentric coordinates: of each cell
  // Used if the kernel has node operators.
  ProjectedNodes<D> projected;
  Interfaces<D> interfaces;
  Extension<D> extension;
  std::vector<KeptWeights<D, K::max_nodes>> kept;  ///< of each strip of a key, where bodies have references and weights are not cheap
  SparseRows<ChangeOnHat<D>> changes;              ///< symmetric affine FLIP: what goes back to particles, on each linear shape function
  std::vector<Vec<D>> changes_of_nodes;            ///< and on each node [m/s]
  SparseRows<Mat<D>> gradient_of_remapped;         ///< MUSL: gradient of the remapped velocities on each linear shape function [1/s]

  KernelRows(const Mesh<D>& mesh, const K& of_kernel, std::size_t number)
      : kernel(of_kernel),
        field(number),
        blocks(make_block_rows<Sum>(mesh, [&](Index c) { return kernel.stencil(mesh, c); })),
        halo(blocks.size())
  {
    if constexpr (projects) {
      projected.sum.resize(static_cast<std::size_t>(mesh.n_nodes()));
      projected.motion.resize(projected.sum.size());
    }
  }

  /// Makes room for the weights of so many strips, unless they are cheap.
  void keep_weights(std::size_t strips)
  {
    if constexpr (!WeighsVertices<K, D>)
      kept.assign(strips, {});
  }
  /// The memory [B], without that of the halo, where these shares of the nodes are in use and of the blocks hold particles.
  std::int64_t bytes(Real of_nodes, Real of_blocks) const
  {
    const Real in_use = of_nodes * static_cast<Real>(bytes_of_all(changes, gradient_of_remapped, projected.sum, projected.motion)) +
                        of_blocks * static_cast<Real>(bytes_of_all(moments, blocks.row) + interfaces.bytes_of_cells());
    std::size_t weights = 0;
    for (const auto& of_strip : kept)
      weights += of_strip.bytes();
    return static_cast<std::int64_t>(in_use) + static_cast<std::int64_t>(weights) +
           static_cast<std::int64_t>(bytes_of_all(blocks.slot) + interfaces.bytes_of_nodes() + extension.bytes() + surfaces.bytes());
  }
};

/// The nodes of the velocity field that the rows belong to.
template <class OfModel, int D, Kernel<D> K>
auto& nodes_of(OfModel& m, const KernelRows<D, K>& of) noexcept
{
  return m.work.fields[of.field].nodes;
}

/// Sends the rows of outer blocks to the owners of their nodes.
template <class What, int D, Kernel<D> K>
void send_rows(std::span<KernelRows<D, K>> fields)
{
  for (KernelRows<D, K>& of : fields)
    of.halo.template send_rows<What>(of.blocks);
}

}  // namespace talus
