#pragma once
// Nodes -> particles (G2P): velocity, velocity gradient and the move.
#include "core/health.hpp"
#include "solver/scatter.hpp"

namespace talus {

/// Motion of the nodes of one cell's stencil, one array per component.
template <int D, int N>
struct CellMotion {
  alignas(64) Real v[D][N];
  alignas(64) Real change[D][N];

  void read(const std::vector<NodeMotion<D>>& motion, std::span<const Index> nodes, int padded_size) noexcept
  {
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      const NodeMotion<D>& row = motion[static_cast<std::size_t>(nodes[a])];
      for (int i = 0; i < D; ++i) {
        v[i][a] = row.v[i];
        change[i][a] = row.change[i];
      }
    }
    for (auto a = static_cast<int>(nodes.size()); a < padded_size; ++a)
      for (int i = 0; i < D; ++i)
        v[i][a] = change[i][a] = 0;
  }
};

/// What a particle sees of the nodes.
template <int D>
struct Seen {
  Vec<D> v, change;  ///< sum w v,  sum w change  [m/s]
  Mat<D> L;          ///< sum v (x) G  [1/s]
};

/// `change` and `L` are found only if asked for.
template <bool with_change, bool with_gradient, int D, int N>
Seen<D> see(const CellMotion<D, N>& motion, const Weights<D, N>& weights, int padded_size) noexcept
{
  Pack v[D]{}, change[D]{}, L[D][D]{};
  for (int a = 0; a < padded_size; a += pack_size) {
    const Pack w = load(weights.w + a);
    for (int i = 0; i < D; ++i) {
      const Pack vi = load(motion.v[i] + a);
      v[i] += w * vi;
      if constexpr (with_change)
        change[i] += w * load(motion.change[i] + a);
      if constexpr (with_gradient)
        for (int j = 0; j < D; ++j)
          L[i][j] += vi * load(weights.dw[j] + a);
    }
  }
  Seen<D> seen;
  for (int i = 0; i < D; ++i) {
    seen.v[i] = sum(v[i]);
    seen.change[i] = sum(change[i]);
    for (int j = 0; j < D; ++j)
      seen.L(i, j) = sum(L[i][j]);
  }
  return seen;
}

/// APIC's affine field B D^-1 with B = sum w v (x) r, D = sum w r (x) r, r = x_v - x_p.  D is indefinite near the boundary of a
/// mesh where weights turn negative, and singular on nodes; there the kernel's own gradient L takes its place.
template <int D, int N>
Mat<D> apic_field(const StencilCell<D, N>& cell, const CellMotion<D, N>& motion, const Weights<D, N>& weights, const Vec<D>& x, const Mat<D>& L) noexcept
{
  Mat<D> B = Mat<D>::Zero(), moment = Mat<D>::Zero();
  Real spread = 0;  // sum |w| r^2, the scale of `moment`
  for (int a = 0; a < cell.size; ++a) {
    Vec<D> r, v;
    for (int i = 0; i < D; ++i) {
      r[i] = cell.x[i][a] - x[i];
      v[i] = motion.v[i][a];
    }
    B += weights.w[a] * v * r.transpose();
    moment += weights.w[a] * r * r.transpose();
    spread += std::abs(weights.w[a]) * r.squaredNorm();
  }
  constexpr Real least_share = 1e-2;  // of the mean second moment: below, B D^-1 amplifies round-off and sign errors
  bool sound = spread > 0;
  for (int k = 1; k <= D; ++k)  // positive definite with room: leading minors against powers of the scale
    sound = sound && moment.topLeftCorner(k, k).determinant() > std::pow(least_share * spread / D, k);
  return sound ? Mat<D>(B * moment.inverse()) : L;
}

/// v_p, and L_p and the affine field where the scheme or the stress need them.
template <bool affine, bool with_gradient, int D, int N>
Seen<D> take_velocity(const StencilCell<D, N>& cell, const CellMotion<D, N>& motion, const Weights<D, N>& weights, Scheme scheme, Real pic, Particles<D>& particles, std::size_t p) noexcept
{
  const Seen<D> seen = see<!affine, with_gradient>(motion, weights, cell.padded_size);
  if constexpr (affine)
    particles.v[p] = seen.v;
  else
    particles.v[p] = (1 - pic) * (particles.v[p] + seen.change) + pic * seen.v;
  if constexpr (with_gradient)
    particles.L[p] = seen.L;
  if constexpr (affine)
    if (scheme == Scheme::apic)
      particles.C[p] = apic_field(cell, motion, weights, particles.x[p], seen.L);
  return seen;
}

namespace detail {

/// Calls f(p, cell, motion, weights) for every particle of a block, motion read once per run, and `done(cell)` after each run.
template <int D, Kernel<D> K, class F, class Done>
void for_each_seen_in_block(const K& kernel, const Mesh<D>& mesh, const Particles<D>& particles, Index n_bodies, const CellOrder& order, Index b,
                            const std::vector<NodeMotion<D>>& nodes, F&& f, Done&& done)
{
  typename K::Cell cell;
  Weights<D, K::max_nodes> weights;
  CellMotion<D, K::max_nodes> motion;
  for (Index body = 0; body < n_bodies; ++body)
    for_each_run(order.rows(body, b), particles.cell, [&](Index c, std::span<const Index> run) {
      kernel.open(mesh, c, cell);
      motion.read(nodes, cell.nodes, cell.padded_size);
      for (const Index row : run) {
        const auto p = static_cast<std::size_t>(row);
        kernel.evaluate(cell, particles.x[p], weights);
        f(p, cell, motion, weights);
      }
      done(cell);
    });
}

template <int D, Kernel<D> K, class F>
void for_each_seen(const K& kernel, const Mesh<D>& mesh, const Particles<D>& particles, Index n_bodies, const CellOrder& order, const std::vector<NodeMotion<D>>& nodes, F&& f)
{
  parallel_for_uneven(order.blocks, [&](Index b) { for_each_seen_in_block(kernel, mesh, particles, n_bodies, order, b, nodes, f, [](const auto&) {}); });
}

template <bool affine, int D, Kernel<D> K>
void gather(const K& kernel, const Mesh<D>& mesh, Index n_bodies, const CellOrder& order, const std::vector<NodeMotion<D>>& nodes, const Transfer& transfer, Real dt,
            Particles<D>& particles)
{
  const Real pic = transfer.pic_share(dt);
  for_each_seen(kernel, mesh, particles, n_bodies, order, nodes, [&](std::size_t p, const auto& cell, const auto& motion, const auto& weights) {
    const Seen<D> seen = take_velocity<affine, true>(cell, motion, weights, transfer.scheme, pic, particles, p);
    particles.x[p] += dt * seen.v;
  });
}

template <bool affine, int D, Kernel<D> K>
void gather_and_return_momentum(const K& kernel, const Mesh<D>& mesh, Index n_bodies, const CellOrder& order, const std::vector<NodeMotion<D>>& nodes, const Transfer& transfer, Real dt,
                                Particles<D>& particles, BlockRows<D>& blocks)
{
  const Real pic = transfer.pic_share(dt);
  parallel_for_uneven(order.blocks, [&](Index b) {
    if (!blocks.occupied[static_cast<std::size_t>(b)])
      return;
    const auto rows = blocks.rows(b);
    std::fill(rows.begin(), rows.end(), NodeSum<D>{});
    CellSums<D, K::max_nodes> sums;
    bool first = true;
    for_each_seen_in_block(
        kernel, mesh, particles, n_bodies, order, b, nodes,
        [&](std::size_t p, const auto& cell, const auto& motion, const auto& weights) {
          if (std::exchange(first, false))
            sums.clear(cell.padded_size);
          take_velocity<affine, affine>(cell, motion, weights, transfer.scheme, pic, particles, p);
          deposit<affine, false, false>(particles, p, affine_field(particles, p, transfer.scheme), cell, weights, sums);
        },
        [&](const auto& cell) {
          sums.add_to(rows, blocks.slots(cell.cell));
          first = true;
        });
  });
}

}  // namespace detail

/// v_p, L_p, the affine field, and x_p <- x_p + dt sum w v.
template <int D, Kernel<D> K>
void gather(const K& kernel, const Mesh<D>& mesh, Index n_bodies, const CellOrder& order, const std::vector<NodeMotion<D>>& nodes, const Transfer& transfer, Real dt,
            Particles<D>& particles)
{
  if (transfer.affine())
    detail::gather<true>(kernel, mesh, n_bodies, order, nodes, transfer, dt, particles);
  else
    detail::gather<false>(kernel, mesh, n_bodies, order, nodes, transfer, dt, particles);
}

/// MUSL, first half: v_p, whose momentum goes back at once to the rows of the blocks with the weights at hand.
template <int D, Kernel<D> K>
void gather_and_return_momentum(const K& kernel, const Mesh<D>& mesh, Index n_bodies, const CellOrder& order, const std::vector<NodeMotion<D>>& nodes, const Transfer& transfer, Real dt,
                                Particles<D>& particles, BlockRows<D>& blocks)
{
  if (transfer.affine())
    detail::gather_and_return_momentum<true>(kernel, mesh, n_bodies, order, nodes, transfer, dt, particles, blocks);
  else
    detail::gather_and_return_momentum<false>(kernel, mesh, n_bodies, order, nodes, transfer, dt, particles, blocks);
}

/// MUSL, second half: L_p from the remapped velocities, while particles move with those of the step itself.
/// Rows hold the remapped velocity in `v` and the step's own in `change`.
template <int D, Kernel<D> K>
void gather_gradient(const K& kernel, const Mesh<D>& mesh, Index n_bodies, const CellOrder& order, const std::vector<NodeMotion<D>>& nodes, Real dt, Particles<D>& particles)
{
  detail::for_each_seen(kernel, mesh, particles, n_bodies, order, nodes, [&](std::size_t p, const auto& cell, const auto& motion, const auto& weights) {
    const Seen<D> seen = see<true, true>(motion, weights, cell.padded_size);
    particles.L[p] = seen.L;
    particles.x[p] += dt * seen.change;
  });
}

}  // namespace talus
