#pragma once
// The particles of a cell, and how far each of them reaches.
#include <cmath>
#include <numeric>

#include "solver/strips/particle_strips.hpp"

namespace talus {

/// Calls f(columns of a strip, place in them) for each particle of a body in a cell.
template <int D, class F>
void for_each_particle_in(const ParticleStrips<D>& strips, Index body, Index cell, F&& f)
{
  const Index block = cell / block_cells, strip = cell % block_cells / strip_cells, c = cell % strip_cells;
  const std::span<const Strip> all = strips.strips(strips.key(body, block));
  if (all.empty())
    return;
  const Strip& one = all[to_size(strip)];
  const Index count = one.count[to_size(c)];
  if (count == 0)
    return;
  const Index begin = std::accumulate(one.count.begin(), one.count.begin() + c, Index{0});
  const StripColumns<D> columns = strips.columns(one);
  for (Index i = begin; i < begin + count; ++i)
    f(columns, to_size(i));
}

/// The same for the particles of several bodies, in their order.
template <int D, class F>
void for_each_particle_in(const ParticleStrips<D>& strips, std::span<const Index> bodies, Index cell, F&& f)
{
  for (const Index body : bodies)
    for_each_particle_in(strips, body, cell, f);
}

/// Half the width of a particle along a unit vector [m]: the stretched half side of a cube of its initial volume.
template <int D>
Real half_width(const Mat3& F, Real volume0, const Vec<D>& along) noexcept
{
  const Mat<D> part = F.template topLeftCorner<D, D>();
  const Real side = D == 2 ? std::sqrt(volume0) : std::cbrt(volume0);
  return 0.5 * side * (part.transpose() * along).norm();
}

}  // namespace talus
