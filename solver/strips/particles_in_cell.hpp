#pragma once
// The particles of a cell, and how far each of them reaches.
#include <cmath>
#include <limits>
#include <numeric>

#include "solver/strips/particle_strips.hpp"

namespace talus {

/// Calls f(columns of a strip, place in them) for each particle of a group in a cell.
template <int D, class F>
void for_each_particle_in(const ParticleStrips<D>& strips, Index group, Index cell, F&& f)
{
  const Index block = cell / block_cells, strip = cell % block_cells / strip_cells, c = cell % strip_cells;
  const std::span<const Strip> all = strips.strips(strips.key(group, block));
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

/// The same for the particles of several groups, in their order.
template <int D, class F>
void for_each_particle_in(const ParticleStrips<D>& strips, std::span<const Index> groups, Index cell, F&& f)
{
  for (const Index group : groups)
    for_each_particle_in(strips, group, cell, f);
}

/// Half the width of a particle along a unit vector [m]: the stretched half side of a cube of its initial volume.
template <int D>
Real half_width(const Mat3& F, Real volume0, const Vec<D>& along) noexcept
{
  const Mat<D> part = F.template topLeftCorner<D, D>();
  const Real side = D == 2 ? std::sqrt(volume0) : std::cbrt(volume0);
  return 0.5 * side * (part.transpose() * along).norm();
}

/// No particle reaches anywhere.
inline constexpr Real nowhere = -std::numeric_limits<Real>::infinity();

/// How far the particles of groups in these cells reach along a unit vector from a node [m], of those whose centres lie at most `beside` [m]
/// from the line through the node.
template <int D>
Real reach_beside(const ParticleStrips<D>& strips, std::span<const Index> groups, std::span<const Index> cells, const Vec<D>& node,
                  const Vec<D>& along, Real beside)
{
  Real reach = nowhere;
  for (const Index c : cells)
    for_each_particle_in<D>(strips, groups, c, [&](const StripColumns<D>& columns, std::size_t p) {
      const Vec<D> arm = columns.x.of(p) - node;
      const Real height = along.dot(arm);
      if (arm.squaredNorm() - height * height <= beside * beside)
        reach = std::max(reach, height + half_width<D>(columns.F.of(p), columns.volume0.of(p), along));
    });
  return reach;
}

}  // namespace talus
