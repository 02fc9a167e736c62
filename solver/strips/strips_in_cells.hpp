#pragma once
// Loops over the particles of a cell, of one or several groups.
#include <numeric>
#include <span>

#include "solver/strips/particle_strips.hpp"

namespace talus {

/// Particles [begin, end) of a strip, in one cell.
template <int D>
struct ParticlesInCell {
  StripColumns<D> columns;
  StripColumn<Real> history;
  std::size_t begin, end;
};

/// Calls f(cell, runs) for each cell of a block that contains particles of the groups, ascending; runs(g) calls g(ParticlesInCell) for each
/// of these groups that has some there, in the order of `groups`.  Particles that a step has moved are in the cell that they come from.
template <int D, class F>
void for_each_cell_of(const ParticleStrips<D>& strips, std::span<const Index> groups, Index block, F&& f)
{
  for (Index s = 0; s < strips_in_block; ++s) {
    const auto for_each_strip = [&](auto&& g) {
      for (const Index group : groups)
        if (const auto all = strips.strips(strips.key(group, block)); !all.empty() && all[to_size(s)].n > 0)
          g(all[to_size(s)]);
    };
    for (Index c = 0; c < strip_cells; ++c) {
      Index particles = 0;
      for_each_strip([&](const Strip& strip) { particles += strip.count[to_size(c)]; });
      if (particles > 0)
        f(strips.first_cell(strips.key(0, block), s) + c, [&](auto&& g) {
          for_each_strip([&](const Strip& strip) {
            if (const Index count = strip.count[to_size(c)]; count > 0) {
              const Index begin = std::accumulate(strip.count.begin(), strip.count.begin() + c, Index{0});
              g(ParticlesInCell<D>{strips.columns(strip), strips.history(strip), to_size(begin), to_size(begin + count)});
            }
          });
        });
    }
  }
}

}  // namespace talus
