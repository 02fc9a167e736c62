#pragma once
// Particles of a cell, four at a time, and what they see of the nodes.
#include <span>

#include "core/particles.hpp"
#include "kernels/pack.hpp"

namespace talus {

/// Up to four particles of one cell.
struct Bunch {
  std::size_t p[pack_size];  ///< rows; the last one repeated where there are fewer than four
  int count;

  /// f(p) of every lane.
  template <class F>
  Pack lanes(F&& f) const noexcept
  {
    return Pack{f(p[0]), f(p[1]), f(p[2]), f(p[3])};
  }
};

/// f(bunch, x) for the particles of a run, four at a time.
template <int D, class F>
void for_each_bunch(std::span<const Index> run, const std::vector<Vec<D>>& places, F&& f)
{
  for (std::size_t begin = 0; begin < run.size(); begin += pack_size) {
    Bunch bunch;
    bunch.count = static_cast<int>(std::min<std::size_t>(pack_size, run.size() - begin));
    for (std::size_t lane = 0; lane < pack_size; ++lane)
      bunch.p[lane] = static_cast<std::size_t>(run[std::min(begin + lane, run.size() - 1)]);
    Pack x[D];
    for (int d = 0; d < D; ++d)
      x[d] = bunch.lanes([&](std::size_t p) { return places[p][d]; });
    f(std::as_const(bunch), std::as_const(x));
  }
}

/// What four particles see of the nodes.
template <int D>
struct Seen {
  Pack v[D], change[D];  ///< sum w v,  sum w change  [m/s]
  Pack L[D][D];          ///< sum v (x) G  [1/s]
};

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

}  // namespace talus
