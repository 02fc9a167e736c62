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

/// What four particles see of the nodes.
template <int D>
struct Seen {
  Pack v[D], change[D];  ///< sum w v,  sum w change  [m/s]
  Pack L[D][D];          ///< sum v (x) G  [1/s]
};

/// Sums over the stencil for one particle, four nodes a lane.  Without the gradient `v` is sum w v, otherwise sum s v.
template <int D, bool with_change, bool with_gradient>
struct StencilSums {
  Pack v[D];
  Pack change[with_change ? D : 1];   ///< w change
  Pack vy[with_gradient ? D : 1][D];  ///< s v (x) y
};
template <bool with_change, bool with_gradient, int D, int N>
[[gnu::always_inline]] inline void sweep(const CellMotion<D, N>& motion, const Weights<D, N>& weights, int lane,
                                         StencilSums<D, with_change, with_gradient>& total) noexcept
{
  Pack v[D]{}, change[D]{}, vy[D][D]{}, slope[D];
  const Pack value = broadcast(weights.value[lane]);
  for (int j = 0; j < D; ++j)
    slope[j] = broadcast(weights.slope[j][lane]);
  for (int a = 0; a < weights.padded_size[lane]; a += pack_size) {
    const Pack s = load(weights.s[lane] + a);
    Pack y[D], w = value;
    for (int j = 0; j < D; ++j) {
      y[j] = load(weights.y[lane][j] + a);
      w -= slope[j] * y[j];
    }
    w *= s;
    for (int i = 0; i < D; ++i) {
      const Pack share = (with_gradient ? s : w) * load(motion.v[i] + a);
      v[i] += share;
      if constexpr (with_gradient)
        for (int j = 0; j < D; ++j)
          vy[i][j] += share * y[j];
      if constexpr (with_change)
        change[i] += w * load(motion.change[i] + a);
    }
  }
  for (int i = 0; i < D; ++i) {
    total.v[i] = v[i];
    if constexpr (with_change)
      total.change[i] = change[i];
    if constexpr (with_gradient)
      for (int j = 0; j < D; ++j)
        total.vy[i][j] = vy[i][j];
  }
}

/// `change` and `L` are found only if asked for.
template <bool with_change, bool with_gradient, int D, int N>
Seen<D> see(const CellMotion<D, N>& motion, const Weights<D, N>& weights, int count) noexcept
{
  StencilSums<D, with_change, with_gradient> of[pack_size];
  for (int lane = 0; lane < pack_size; ++lane)
    if (lane < count)
      sweep(motion, weights, lane, of[lane]);
    else
      of[lane] = of[count - 1];
  const auto total = [&](auto&& entry) __attribute__((always_inline))
  {
    return sums(entry(of[0]), entry(of[1]), entry(of[2]), entry(of[3]));
  };

  Seen<D> seen;
  for (int i = 0; i < D; ++i) {
    seen.v[i] = total([&](const auto& one) { return one.v[i]; });
    if constexpr (with_change)
      seen.change[i] = total([&](const auto& one) { return one.change[i]; });
    if constexpr (with_gradient) {
      const Pack sv = seen.v[i];
      Pack vy[D];
      seen.v[i] *= weights.value;
      for (int j = 0; j < D; ++j) {
        vy[j] = total([&](const auto& one) { return one.vy[i][j]; });
        seen.v[i] -= vy[j] * weights.slope[j];
      }
      for (int j = 0; j < D; ++j) {
        seen.L[i][j] = -sv * weights.shift[j];
        for (int k = 0; k < D; ++k)
          seen.L[i][j] += vy[k] * weights.H(k, j);
      }
    }
  }
  return seen;
}

/// One lane of what was seen.
template <int D>
Vec<D> lane_of(const Pack (&v)[D], int lane) noexcept
{
  Vec<D> one;
  for (int i = 0; i < D; ++i)
    one[i] = v[i][lane];
  return one;
}
template <int D>
Mat<D> lane_of(const Pack (&L)[D][D], int lane) noexcept
{
  Mat<D> one;
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j)
      one(i, j) = L[i][j][lane];
  return one;
}

/// APIC's affine field B D^-1 with B = sum w v (x) r, D = sum w r (x) r, r = x_v - x_p.  D is indefinite near the boundary of a
/// mesh where weights turn negative, and singular on nodes; there the kernel's own gradient L takes its place.
template <int D, int N>
Mat<D> apic_field(const StencilCell<D, N>& cell, const CellMotion<D, N>& motion, const Weights<D, N>& weights, int lane, const Vec<D>& x,
                  const Mat<D>& L) noexcept
{
  NodeWeights<D, N> plain;
  weights.spell_out(lane, plain);
  Mat<D> B = Mat<D>::Zero(), moment = Mat<D>::Zero();
  Real spread = 0;  // sum |w| r^2, the scale of `moment`
  for (int a = 0; a < cell.size; ++a) {
    Vec<D> r, v;
    for (int i = 0; i < D; ++i) {
      r[i] = cell.x[i][a] - (x[i] - cell.origin[i]);
      v[i] = motion.v[i][a];
    }
    B += plain.w[a] * v * r.transpose();
    moment += plain.w[a] * r * r.transpose();
    spread += std::abs(plain.w[a]) * r.squaredNorm();
  }
  constexpr Real least_share = 1e-2;  // of the mean second moment: below, B D^-1 amplifies round-off and sign errors
  bool sound = spread > 0;
  for (int k = 1; k <= D; ++k)  // positive definite with room: leading minors against powers of the scale
    sound = sound && moment.topLeftCorner(k, k).determinant() > std::pow(least_share * spread / D, k);
  return sound ? Mat<D>(B * moment.inverse()) : L;
}

/// v_p, and L_p and the affine field where the scheme or the stress need them.
template <bool affine, bool with_gradient, int D, int N>
Seen<D> take_velocity(const StencilCell<D, N>& cell, const CellMotion<D, N>& motion, const Weights<D, N>& weights, Scheme scheme, Real pic,
                      const Bunch& bunch, Particles<D>& particles) noexcept
{
  const Seen<D> seen = see<!affine, with_gradient>(motion, weights, bunch.count);
  for (int lane = 0; lane < bunch.count; ++lane) {
    const std::size_t p = bunch.p[lane];
    const Vec<D> v = lane_of<D>(seen.v, lane);
    if constexpr (affine)
      particles.v[p] = v;
    else
      particles.v[p] = (1 - pic) * (particles.v[p] + lane_of<D>(seen.change, lane)) + pic * v;
    if constexpr (with_gradient)
      particles.L[p] = lane_of<D>(seen.L, lane);
    if constexpr (affine)
      if (scheme == Scheme::apic)
        particles.C[p] = apic_field(cell, motion, weights, lane, particles.x[p], particles.L[p]);
  }
  return seen;
}

/// x <- x + dt v
template <int D>
void move(const Bunch& bunch, const Pack (&v)[D], Real dt, Particles<D>& particles) noexcept
{
  for (int lane = 0; lane < bunch.count; ++lane)
    for (int i = 0; i < D; ++i)
      particles.x[bunch.p[lane]][i] += dt * v[i][lane];
}

namespace detail {

/// Calls f(bunch, cell, motion, weights) for all particles of a block, motion read once per run, and `done(cell)` after each run.
template <int D, Kernel<D> K, class F, class Done>
void for_each_seen_in_block(const K& kernel, const Mesh<D>& mesh, const Particles<D>& particles, Index n_bodies, const CellOrder& order,
                            Index b, const std::vector<NodeMotion<D>>& nodes, F&& f, Done&& done)
{
  typename K::Cell cell;
  Weights<D, K::max_nodes> weights;
  CellMotion<D, K::max_nodes> motion;
  for (Index body = 0; body < n_bodies; ++body)
    for_each_run(order.rows(body, b), particles.cell, [&](Index c, std::span<const Index> run) {
      kernel.open(mesh, c, cell);
      motion.read(nodes, cell.nodes, cell.padded_size);
      for_each_bunch<D>(run, particles.x, [&](const Bunch& bunch, const Pack(&x)[D]) {
        kernel.evaluate(cell, x, bunch.count, weights);
        f(bunch, cell, motion, weights);
      });
      done(cell);
    });
}

template <int D, Kernel<D> K, class F>
void for_each_seen(const K& kernel, const Mesh<D>& mesh, const Particles<D>& particles, Index n_bodies, const CellOrder& order,
                   const std::vector<NodeMotion<D>>& nodes, F&& f)
{
  parallel_for_uneven(order.blocks,
                      [&](Index b) { for_each_seen_in_block(kernel, mesh, particles, n_bodies, order, b, nodes, f, [](const auto&) {}); });
}

template <bool affine, int D, Kernel<D> K>
void gather(const K& kernel, const Mesh<D>& mesh, Index n_bodies, const CellOrder& order, const std::vector<NodeMotion<D>>& nodes,
            const Transfer& transfer, Real dt, Particles<D>& particles)
{
  const Real pic = transfer.pic_share(dt);
  for_each_seen(kernel, mesh, particles, n_bodies, order, nodes,
                [&](const Bunch& bunch, const auto& cell, const auto& motion, const auto& weights) {
                  const Seen<D> seen = take_velocity<affine, true>(cell, motion, weights, transfer.scheme, pic, bunch, particles);
                  move(bunch, seen.v, dt, particles);
                });
}

template <bool affine, int D, Kernel<D> K>
void gather_and_return_momentum(const K& kernel, const Mesh<D>& mesh, Index n_bodies, const CellOrder& order,
                                const std::vector<NodeMotion<D>>& nodes, const Transfer& transfer, Real dt, Particles<D>& particles,
                                BlockRows<D>& blocks)
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
        [&](const Bunch& bunch, const auto& cell, const auto& motion, const auto& weights) {
          if (std::exchange(first, false))
            sums.clear(cell.padded_size);
          take_velocity<affine, affine>(cell, motion, weights, transfer.scheme, pic, bunch, particles);
          deposit<affine, false, false>(particles, bunch, transfer.scheme, cell, weights, sums);
        },
        [&](const auto& cell) {
          sums.add_to(rows, blocks.slots(cell.cell), NodeSum<D>::unseen);
          first = true;
        });
  });
}

}  // namespace detail

/// v_p, L_p, the affine field, and x_p <- x_p + dt sum w v.
template <int D, Kernel<D> K>
void gather(const K& kernel, const Mesh<D>& mesh, Index n_bodies, const CellOrder& order, const std::vector<NodeMotion<D>>& nodes,
            const Transfer& transfer, Real dt, Particles<D>& particles)
{
  if (transfer.affine())
    detail::gather<true>(kernel, mesh, n_bodies, order, nodes, transfer, dt, particles);
  else
    detail::gather<false>(kernel, mesh, n_bodies, order, nodes, transfer, dt, particles);
}

/// MUSL, first half: v_p, whose momentum goes back at once to the rows of the blocks with the weights at hand.
template <int D, Kernel<D> K>
void gather_and_return_momentum(const K& kernel, const Mesh<D>& mesh, Index n_bodies, const CellOrder& order,
                                const std::vector<NodeMotion<D>>& nodes, const Transfer& transfer, Real dt, Particles<D>& particles,
                                BlockRows<D>& blocks)
{
  if (transfer.affine())
    detail::gather_and_return_momentum<true>(kernel, mesh, n_bodies, order, nodes, transfer, dt, particles, blocks);
  else
    detail::gather_and_return_momentum<false>(kernel, mesh, n_bodies, order, nodes, transfer, dt, particles, blocks);
}

/// MUSL, second half: L_p from the remapped velocities, while particles move with those of the step itself.
/// Rows hold the remapped velocity in `v` and the step's own in `change`.
template <int D, Kernel<D> K>
void gather_gradient(const K& kernel, const Mesh<D>& mesh, Index n_bodies, const CellOrder& order, const std::vector<NodeMotion<D>>& nodes,
                     Real dt, Particles<D>& particles)
{
  detail::for_each_seen(kernel, mesh, particles, n_bodies, order, nodes,
                        [&](const Bunch& bunch, const auto&, const auto& motion, const auto& weights) {
                          const Seen<D> seen = see<true, true>(motion, weights, bunch.count);
                          for (int lane = 0; lane < bunch.count; ++lane)
                            particles.L[bunch.p[lane]] = lane_of<D>(seen.L, lane);
                          move(bunch, seen.change, dt, particles);
                        });
}

}  // namespace talus
