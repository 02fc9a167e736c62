#pragma once
// Particles -> rows of their block of cells (P2G).
#include <utility>

#include "solver/model.hpp"

namespace talus {
namespace detail {

template <class S, int D>
float lightest_of(const Particles<D>& particles, std::span<const Index> run) noexcept
{
  const S* const mass = particles.mass.template rows<S>();
  float lightest = NodeSum<D>::unseen;
  for (const Index p : run)
    lightest = std::min(lightest, static_cast<float>(mass[p]));
  return lightest;
}

template <class S, bool affine, bool loaded, int D, Kernel<D> K>
void scatter(Model<D, K>& m)
{
  for_each_own_block<Whole>(m.blocks, m.halo, [&](Index b) {
    const auto rows = m.blocks.rows(b);
    Through<D, K> through(m.kernel);
    bool occupied = false;
    const auto ask = [&](std::size_t p) {
      Prefetch<S>::row(p, m.particles.x, m.particles.v, m.particles.affine_fields(), m.particles.stress, m.particles.mass,
                       m.particles.volume);
    };
    for (Index body = 0; body < m.n_bodies(); ++body)
      for_each_run(
          m.order.rows(body, b), m.particles.cell,
          [&](Index c, std::span<const Index> run) {
            if (!std::exchange(occupied, true))
              std::fill(rows.begin(), rows.end(), typename Through<D, K>::Sum{});
            through.enter(m.mesh, c);
            through.clear();
            for_each_placed_bunch<S, D>(run, m.particles.x, [&](const ParticlePackOf<S>& pack, const Pack(&x)[D]) {
              through.place(pack, x);
              through.template deposit<affine, loaded, true>(m.particles, pack, x, m.particles.affine_fields());
            });
            through.template add_to<affine, loaded, true>(rows, m.blocks.slots(c), lightest_of<S>(m.particles, run));
          },
          ask);
    if (std::exchange(m.blocks.occupied[static_cast<std::size_t>(b)], occupied ? 1 : 0) && !occupied)
      std::fill(rows.begin(), rows.end(), typename Through<D, K>::Sum{});  // nothing left for others to read
  });
}

}  // namespace detail

/// Mass, momentum and force of every particle, into the rows of its block.
template <int D, Kernel<D> K>
void scatter(Model<D, K>& m)
{
  const bool loaded = !m.particles.applied.empty();
  in_numbers_of(m.particles, [&]<class S>(S) {
    if (m.transfer.affine())
      loaded ? detail::scatter<S, true, true>(m) : detail::scatter<S, true, false>(m);
    else
      loaded ? detail::scatter<S, false, true>(m) : detail::scatter<S, false, false>(m);
  });
}

}  // namespace talus
