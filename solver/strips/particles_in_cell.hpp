#pragma once
// The particles of some bodies in one cell.
#include <numeric>

#include "solver/strips/particle_strips.hpp"

namespace talus {

/// Calls f(columns, row) for the particles of these bodies in a cell, in the order of bodies and rows.
template <int D, class F>
void for_each_particle_in_cell(const ParticleStrips<D>& strips, std::span<const Index> bodies, Index cell, F&& f)
{
  const Index block = cell / block_cells, strip = cell % block_cells / strip_cells, c = cell % strip_cells;
  for (const Index body : bodies) {
    const std::span<const Strip> all = strips.strips(strips.key(body, block));
    if (all.empty())
      continue;
    const Strip& one = all[to_size(strip)];
    const Index count = one.count[to_size(c)];
    if (count == 0)
      continue;
    const Index begin = std::accumulate(one.count.begin(), one.count.begin() + c, Index{0});
    const StripColumns<D> columns = strips.columns(one);
    for (Index i = begin; i < begin + count; ++i)
      f(columns, to_size(i));
  }
}

}  // namespace talus
