#pragma once
// Transfer from nodes to particles (G2P): velocity, velocity gradient and motion.
#include "solver/transfer/scatter.hpp"

namespace talus {
namespace detail {

/// Computes v_p and, if needed, the velocity gradient and the affine field of the scheme: into L, or into C where the scheme stores it
/// separately.  With `musl` L is computed later, from remapped velocities.
template <bool increments, bool with_gradient, bool musl, int D, class Through_>
Interpolated<D> take_velocity(const Through_& through, Scheme scheme, Real pic, const ParticlePack& pack, Particles<D>& particles) noexcept
{
  const Interpolated<D> seen = through.template see<increments, with_gradient>(pack);
  VecOf<D> v = vector_of(seen.v);
  if constexpr (increments)
    v = SimdReal(1 - pic) * (pack.load(particles.v) + vector_of(seen.change)) + SimdReal(pic) * v;
  pack.store(v, particles.v);
  if constexpr (with_gradient) {
    const MatOf<D> L = matrix_of(seen.L);
    pack.store(L, musl ? particles.C : particles.L);
    if (scheme == Scheme::apic) {
      if constexpr (Through_::has_apic)
        for (int lane = 0; lane < pack.count; ++lane) {
          const std::size_t p = pack.p[lane];
          particles.C.set(p, through.apic_field(lane, particles.x[p], lane_of(L, lane)));
        }
      else
        pack.store(L, particles.C);
    }
  }
  return seen;
}

/// Moves the particles of a cell, x <- x + dt v, and lists those that may have left it.
template <int D>
class Mover {
 public:
  Mover(Model<D>& m, Index body, Index block, Index cell, Real dt)
      : particles_(m.state.particles),
        order_(m.work.order),
        key_(order_.key(body, block)),
        probe_(m.problem.locator.probe(m.problem.mesh, cell)),
        dt_(dt)
  {}
  void operator()(const ParticlePack& pack, const Pack (&x)[D], const Pack (&v)[D]) const noexcept
  {
    const VecOf<D> there = vector_of(x) + SimdReal(dt_) * vector_of(v);
    pack.store(there, particles_.x);
    add_leaving<D>(probe_, pack, there, key_, order_);
  }

 private:
  Particles<D>& particles_;
  CellOrder& order_;
  std::size_t key_;
  typename Locator<D>::Probe probe_;
  Real dt_;
};

/// Calls f(body, c, run, through) for the cell batches of a block, with the cell opened and its part of `motion` read; ask(p) before each row is
/// used, see PrefetchRows; then done(body) for each body.
template <int D, Kernel<D> K, class Ask, class F, class Done>
void for_each_reading_run(const Model<D>& m, const KernelRows<D, K>& of, Index b,
                          const std::vector<typename KernelRows<D, K>::Motion>& motion, Ask&& ask, F&& f, Done&& done)
{
  typename KernelRows<D, K>::Through through(of.kernel);
  for (Index body = 0; body < m.n_bodies(); ++body) {
    for_each_run(
        m.work.order.rows(body, b), m.state.particles.cell,
        [&](Index c, std::span<const Index> run) {
          through.enter(m.problem.mesh, c);
          through.read(motion);
          f(body, c, run, through);
        },
        ask);
    done(body);
  }
}

/// Receives the motion of nodes of other ranks that own particles use; for linear shape functions it has already arrived.
template <int D, Kernel<D> K>
void take_motion([[maybe_unused]] Model<D>& m, KernelRows<D, K>& of)
{
  if constexpr (!HasNodeOperators<K, D>)
    of.ghosts.motion.take(m.work.nodes.motion, Whole{});
}

template <bool increments, int D, Kernel<D> K, class Then>
void gather(Model<D>& m, KernelRows<D, K>& of, Real dt, Then&& then)
{
  const Real pic = m.problem.transfer.pic_share(dt, m.state.crossing);
  for_each_reading_block(
      of.halo, [&] { take_motion(m, of); },
      [&](Index b) {
        for_each_reading_run(
            m, of, b, of.motion(m.work.nodes),
            [&](std::size_t p) { prefetch_row(p, m.state.particles.x, m.state.particles.v, m.state.particles.L); },
            [&](Index body, Index c, std::span<const Index> run, auto& through) {
              const Mover<D> move(m, body, b, c, dt);
              for_each_placed_pack<D>(run, m.state.particles.x, [&](const ParticlePack& pack, const Pack(&x)[D]) {
                through.place(pack, x);
                const Interpolated<D> seen =
                    take_velocity<increments, true, false>(through, m.problem.transfer.scheme, pic, pack, m.state.particles);
                move(pack, x, seen.v);
              });
            },
            [&](Index body) { then(body, b); });
      });
}

template <bool increments, bool affine, int D, Kernel<D> K>
void gather_and_return_momentum(Model<D>& m, KernelRows<D, K>& of, Real dt)
{
  const Real pic = m.problem.transfer.pic_share(dt, m.state.crossing);
  take_motion(m, of);  // blocks that use nodes of other ranks have rows for them, which must be sent first
  for_each_own_block<MomentumAlone>(of.blocks, of.halo, [&](Index b) {
    if (!of.blocks.occupied[static_cast<std::size_t>(b)])
      return;
    const auto row = of.blocks.rows(b);
    std::fill(row.begin(), row.end(), typename KernelRows<D, K>::Sum{});
    for_each_reading_run(
        m, of, b, of.motion(m.work.nodes),
        [&](std::size_t p) { prefetch_row(p, m.state.particles.x, m.state.particles.v, m.state.particles.affine_fields()); },
        [&](Index, Index c, std::span<const Index> run, auto& through) {
          through.clear();
          for_each_placed_pack<D>(run, m.state.particles.x, [&](const ParticlePack& pack, const Pack(&x)[D]) {
            through.place(pack, x);
            take_velocity<increments, affine, true>(through, m.problem.transfer.scheme, pic, pack, m.state.particles);
            through.template deposit<affine, false, false>(m.state.particles, pack, x, m.state.particles.affine_fields());
          });
          through.template add_to<affine, false, false>(row, of.blocks.slots(c), NodeSum<D>::unseen);
        },
        [](Index) {});
  });
}

}  // namespace detail

struct Nothing {
  void operator()(Index, Index) const noexcept {}
};
/// Computes v_p, L_p and the affine field, and moves x_p <- x_p + dt sum w v.  Calls then(body, block) after the particles of a body in a
/// block, while they are in the cache.
template <int D, Kernel<D> K, class Then = Nothing>
void gather(Model<D>& m, KernelRows<D, K>& of, Real dt, Then&& then = {})
{
  m.problem.transfer.increments() ? detail::gather<true>(m, of, dt, then) : detail::gather<false>(m, of, dt, then);
}

/// MUSL, first half: computes v_p and the affine field, and adds their momentum to the rows of the blocks with the same weights.
template <int D, Kernel<D> K>
void gather_and_return_momentum(Model<D>& m, KernelRows<D, K>& of, Real dt)
{
  if (!m.problem.transfer.affine())
    detail::gather_and_return_momentum<true, false>(m, of, dt);
  else
    m.problem.transfer.increments() ? detail::gather_and_return_momentum<true, true>(m, of, dt)
                                    : detail::gather_and_return_momentum<false, true>(m, of, dt);
}

/// MUSL, second half: computes L_p from the remapped velocities, while particles move with the velocities of the step.  The rows contain
/// the remapped velocity, or its gradient, and the velocity of the step in `change`; arrive() receives those of other ranks.
template <int D, Kernel<D> K, class Arrive, class Then>
void gather_gradient(Model<D>& m, KernelRows<D, K>& of, const std::vector<typename KernelRows<D, K>::Motion>& remapped, Arrive&& arrive,
                     Real dt, Then&& then)
{
  for_each_reading_block(of.halo, arrive, [&](Index b) {
    detail::for_each_reading_run(
        m, of, b, remapped, [&](std::size_t p) { prefetch_row(p, m.state.particles.L); },
        [&](Index body, Index c, std::span<const Index> run, auto& through) {
          const detail::Mover<D> move(m, body, b, c, dt);
          for_each_placed_pack<D>(run, m.state.particles.x, [&](const ParticlePack& pack, const Pack(&x)[D]) {
            through.place(pack, x);
            const Interpolated<D> seen = through.template see<true, true>(pack);
            pack.store(matrix_of(seen.L), m.state.particles.L);
            move(pack, x, seen.change);
          });
        },
        [&](Index body) { then(body, b); });
  });
}

}  // namespace talus
