#pragma once
// The particles of a cell, and how far each of them reaches.
#include <cmath>
#include <limits>
#include <numeric>

#include "solver/strips/particle_strips.hpp"

namespace talus {

/// The particles of a group in a cell: those from `begin` to `end` of the columns of a strip.
template <int D>
struct ColumnsInCell {
  std::size_t key = 0;  ///< of the group and the block of the cell
  Index strip = 0;      ///< number of the strip in its block
  StripColumns<D> columns{};
  std::size_t begin = 0, end = 0;
  /// That of particle p [1/s]; zero without `find_gradients`.
  Mat<D> affine_field(std::size_t p, const FindGradients<D>& find_gradients)
  {
    if (!find_gradients)
      return Mat<D>::Zero();
    if (!columns.L)
      find_gradients(key, strip, columns);
    return columns.affine_field().of(p);
  }
};
template <int D>
ColumnsInCell<D> columns_in_cell(const ParticleStrips<D>& strips, Index group, Index cell)
{
  ColumnsInCell<D> in{.key = strips.key(group, cell / block_cells), .strip = cell % block_cells / strip_cells};
  const std::span<const Strip> all = strips.strips(in.key);
  if (all.empty())
    return in;
  const Strip& one = all[to_size(in.strip)];
  const auto count = one.count.begin() + cell % strip_cells;
  if (*count == 0)
    return in;
  in.begin = to_size(std::accumulate(one.count.begin(), count, Index{0})), in.end = in.begin + to_size(*count);
  in.columns = strips.columns(one);
  return in;
}

/// Calls f(columns of a strip, place in them) for each particle of a group in a cell.
template <int D, class F>
void for_each_particle_in(const ParticleStrips<D>& strips, Index group, Index cell, F&& f)
{
  const ColumnsInCell<D> in = columns_in_cell(strips, group, cell);
  for (std::size_t i = in.begin; i < in.end; ++i)
    f(in.columns, i);
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
