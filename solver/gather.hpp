#pragma once
// Nodes -> particles (G2P): velocity, velocity gradient and the move.
#include "solver/scatter.hpp"

namespace talus {
namespace detail {

/// v_p, and L_p and the affine field where the scheme or the stress need them.
template <bool increments, bool with_gradient, int D, class Through_>
Seen<D> take_velocity(const Through_& through, Scheme scheme, Real pic, const Bunch& bunch, Particles<D>& particles) noexcept
{
  const Seen<D> seen = through.template see<increments, with_gradient>(bunch);
  for (int lane = 0; lane < bunch.count; ++lane) {
    const std::size_t p = bunch.p[lane];
    const Vec<D> v = lane_of<D>(seen.v, lane);
    if constexpr (increments)
      particles.v[p] = (1 - pic) * (particles.v[p] + lane_of<D>(seen.change, lane)) + pic * v;
    else
      particles.v[p] = v;
    if constexpr (with_gradient) {
      const Mat<D> L = particles.L[p] = lane_of<D>(seen.L, lane);
      if (!particles.C.empty()) {
        particles.C[p] = L;
        if constexpr (Through_::has_apic)
          if (scheme == Scheme::apic)
            particles.C[p] = through.apic_field(lane, particles.x[p], L);
      }
    }
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

/// f(c, run, through) for the runs of a block, the cell entered and its share of `motion` read.
template <int D, Kernel<D> K, class F>
void for_each_reading_run(const Model<D, K>& m, Index b, const std::vector<typename Through<D, K>::Motion>& motion, F&& f)
{
  Through<D, K> through(m.kernel);
  for (Index body = 0; body < m.n_bodies(); ++body)
    for_each_run(m.order.rows(body, b), m.particles.cell, [&](Index c, std::span<const Index> run) {
      through.enter(m.mesh, c);
      through.read(motion);
      f(c, run, through);
    });
}

template <bool increments, int D, Kernel<D> K>
void gather(Model<D, K>& m, Real dt)
{
  const Real pic = m.transfer.pic_share(dt, m.crossing);
  parallel_for_uneven(m.order.blocks, [&](Index b) {
    for_each_reading_run(m, b, m.motion(), [&](Index, std::span<const Index> run, auto& through) {
      for_each_bunch<D>(run, m.particles.x, [&](const Bunch& bunch, const Pack(&x)[D]) {
        through.place(bunch, x);
        const Seen<D> seen = take_velocity<increments, true>(through, m.transfer.scheme, pic, bunch, m.particles);
        move(bunch, seen.v, dt, m.particles);
      });
    });
  });
}

template <bool increments, bool affine, int D, Kernel<D> K>
void gather_and_return_momentum(Model<D, K>& m, Real dt)
{
  const Real pic = m.transfer.pic_share(dt, m.crossing);
  parallel_for_uneven(m.order.blocks, [&](Index b) {
    if (!m.blocks.occupied[static_cast<std::size_t>(b)])
      return;
    const auto rows = m.blocks.rows(b);
    std::fill(rows.begin(), rows.end(), typename Through<D, K>::Sum{});
    for_each_reading_run(m, b, m.motion(), [&](Index c, std::span<const Index> run, auto& through) {
      through.clear();
      for_each_bunch<D>(run, m.particles.x, [&](const Bunch& bunch, const Pack(&x)[D]) {
        through.place(bunch, x);
        take_velocity<increments, affine>(through, m.transfer.scheme, pic, bunch, m.particles);
        through.template deposit<affine, false, false>(m.particles, bunch, x, m.particles.affine_fields());
      });
      through.template add_to<affine, false, false>(rows, m.blocks.slots(c), NodeSum<D>::unseen);
    });
  });
}

}  // namespace detail

/// v_p, L_p, the affine field, and x_p <- x_p + dt sum w v.
template <int D, Kernel<D> K>
void gather(Model<D, K>& m, Real dt)
{
  m.transfer.increments() ? detail::gather<true>(m, dt) : detail::gather<false>(m, dt);
}

/// MUSL, first half: v_p and the affine field, whose momentum goes back at once to the rows of the blocks with the weights at hand.
template <int D, Kernel<D> K>
void gather_and_return_momentum(Model<D, K>& m, Real dt)
{
  if (!m.transfer.affine())
    detail::gather_and_return_momentum<true, false>(m, dt);
  else
    m.transfer.increments() ? detail::gather_and_return_momentum<true, true>(m, dt)
                            : detail::gather_and_return_momentum<false, true>(m, dt);
}

/// MUSL, second half: L_p from the remapped velocities, while particles move with those of the step itself.
/// What they read holds the remapped velocity, or its gradient, and the step's own velocity in `change`.
template <int D, Kernel<D> K>
void gather_gradient(Model<D, K>& m, const std::vector<typename Through<D, K>::Motion>& remapped, Real dt)
{
  parallel_for_uneven(m.order.blocks, [&](Index b) {
    detail::for_each_reading_run(m, b, remapped, [&](Index, std::span<const Index> run, auto& through) {
      for_each_bunch<D>(run, m.particles.x, [&](const Bunch& bunch, const Pack(&x)[D]) {
        through.place(bunch, x);
        const Seen<D> seen = through.template see<true, true>(bunch);
        for (int lane = 0; lane < bunch.count; ++lane)
          m.particles.L[bunch.p[lane]] = lane_of<D>(seen.L, lane);
        detail::move(bunch, seen.change, dt, m.particles);
      });
    });
  });
}

}  // namespace talus
