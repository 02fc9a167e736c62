#pragma once
// Data of the transfer of one kernel for a whole run: the kernel, the rows of blocks, and the data between these and the nodes; and the transfer
// from particles to these rows (P2G).
#include <type_traits>
#include <utility>

#include "kernels/kernel.hpp"
#include "solver/halo/halo.hpp"
#include "solver/model/model.hpp"
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

namespace detail {

template <int D>
float lightest_of(const Particles<D>& particles, std::span<const Index> run) noexcept
{
  float lightest = NodeSum<D>::unseen;
  for (const Index p : run)
    lightest = std::min(lightest, static_cast<float>(particles.mass[static_cast<std::size_t>(p)]));
  return lightest;
}

template <bool affine, bool loaded, int D, Kernel<D> K>
void scatter(Model<D>& m, KernelRows<D, K>& of)
{
  for_each_own_block<Whole>(of.blocks, of.halo, [&](Index b) {
    const auto row = of.blocks.rows(b);
    typename KernelRows<D, K>::Through through(of.kernel);
    bool occupied = false;
    const auto ask = [&](std::size_t p) {
      prefetch_row(p, m.state.particles.x, m.state.particles.v, m.state.particles.affine_fields(), m.state.particles.stress,
                   m.state.particles.mass, m.state.particles.volume);
    };
    for (Index body = 0; body < m.n_bodies(); ++body)
      for_each_run(
          m.work.order.rows(body, b), m.state.particles.cell,
          [&](Index c, std::span<const Index> run) {
            if (!std::exchange(occupied, true))
              std::fill(row.begin(), row.end(), typename KernelRows<D, K>::Sum{});
            through.enter(m.problem.mesh, c);
            through.clear();
            for_each_placed_pack<D>(run, m.state.particles.x, [&](const ParticlePack& pack, const Pack(&x)[D]) {
              through.place(pack, x);
              through.template deposit<affine, loaded, true>(m.state.particles, pack, x, m.state.particles.affine_fields());
            });
            through.template add_to<affine, loaded, true>(row, of.blocks.slots(c), lightest_of(m.state.particles, run));
          },
          ask);
    if (std::exchange(of.blocks.occupied[static_cast<std::size_t>(b)], occupied ? 1 : 0) && !occupied)
      std::fill(row.begin(), row.end(), typename KernelRows<D, K>::Sum{});  // no old values for other ranks to read
  });
}

}  // namespace detail

/// Adds mass, momentum and force of every particle to the rows of its block.
template <int D, Kernel<D> K>
void scatter(Model<D>& m, KernelRows<D, K>& of)
{
  const bool loaded = !m.state.particles.applied.empty();
  if (m.problem.transfer.affine())
    loaded ? detail::scatter<true, true>(m, of) : detail::scatter<true, false>(m, of);
  else
    loaded ? detail::scatter<false, true>(m, of) : detail::scatter<false, false>(m, of);
}

}  // namespace talus
