#pragma once
// Nodal values interpolated to particles, four particles at a time.
#include "core/particle_pack.hpp"
#include "solver/state/cell_order.hpp"

namespace talus {

/// Calls f(pack, x) for the particles of a cell batch, four at a time.
template <int D, class F>
void for_each_placed_pack(std::span<const Index> run, const ParticleColumn<Vec<D>>& places, F&& f)
{
  for_each_pack(run, [&](const ParticlePack& pack) {
    Pack x[D];
    const auto place = pack.load(places);
    for (int d = 0; d < D; ++d)
      x[d] = place[d].of;
    f(pack, std::as_const(x));
  });
}

/// Velocities of the nodes, interpolated to four particles.
template <int D>
struct Interpolated {
  Pack v[D], change[D];  ///< sum w v,  sum w change  [m/s]
  Pack L[D][D];          ///< sum v (x) G  [1/s]
};

template <int D>
VecOf<D> vector_of(const Pack (&v)[D]) noexcept
{
  VecOf<D> all;
  for (int i = 0; i < D; ++i)
    all[i] = v[i];
  return all;
}
template <int D>
MatOf<D> matrix_of(const Pack (&L)[D][D]) noexcept
{
  MatOf<D> all;
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j)
      all(i, j) = L[i][j];
  return all;
}

}  // namespace talus
