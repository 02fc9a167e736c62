#pragma once
// The plan for run-out: the vertical direction, and the cells of a grid over a facet.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mesh/geometry/plan_grid.hpp"
#include "mesh/mesh.hpp"

namespace talus {

template <int D>
Vec3 in_space(const Vec<D>& v)
{
  Vec3 x = Vec3::Zero();
  x.template head<D>() = v;
  return x;
}

/// The vertical direction and the axes of the plan, so that east, north and up are right-handed.
struct PlanAxes {
  Vec3 up;                    ///< unit vector against gravity
  Index vertical;             ///< index of the axis nearest to `up`
  Real sign;                  ///< sign of `up` along that axis
  std::array<Index, 2> plan;  ///< 2-D: only the first one
};
template <int D>
PlanAxes plan_axes(const Vec<D>& gravity)
{
  PlanAxes axes;
  axes.up = gravity.norm() > 0 ? Vec3(-in_space<D>(gravity).normalized()) : D == 2 ? Vec3(Vec3::UnitY()) : Vec3(Vec3::UnitZ());
  axes.up.cwiseAbs().maxCoeff(&axes.vertical);
  axes.sign = axes.up[axes.vertical] < 0 ? -1 : 1;
  axes.plan =
      D == 2 ? std::array<Index, 2>{1 - axes.vertical, none} : std::array<Index, 2>{(axes.vertical + 1) % 3, (axes.vertical + 2) % 3};
  return axes;
}

/// Calls f(cell, elevation) for the cells whose centre lies above or below a facet.
template <int D, class F>
void for_each_cell_of(const Mesh<D>& mesh, Facet facet, const PlanGrid& grid, const PlanAxes& axes, F&& f)
{
  std::array<Vec3, D> corner;
  const auto nodes = mesh.nodes_of(facet);
  Vec<2> low = Vec<2>::Constant(std::numeric_limits<Real>::infinity()), high = -low;
  const auto plan = [&](const Vec3& x) { return D == 2 ? Vec<2>(x[axes.plan[0]], 0) : Vec<2>(x[axes.plan[0]], x[axes.plan[1]]); };
  for (std::size_t k = 0; k < D; ++k) {
    corner[k] = in_space<D>(mesh.node(nodes[k]));
    low = low.cwiseMin(plan(corner[k])), high = high.cwiseMax(plan(corner[k]));
  }
  const auto first = [](Real at, Real begin, Real d, Index n) {
    return static_cast<Index>(std::clamp(std::floor((at - begin) / d - 0.5), Real{0}, static_cast<Real>(n - 1)));
  };
  const auto elevation = [&](const Vec3& x) { return axes.sign * x[axes.vertical]; };
  const Vec<2> a = plan(corner[0]), ab = plan(corner[1]) - a, ac = D == 2 ? Vec<2>(0, 1) : Vec<2>(plan(corner[D - 1]) - a);
  const Real area = ab[0] * ac[1] - ab[1] * ac[0];
  if (area == 0)
    return;                   // vertical
  constexpr Real rim = 1e-9;  // relative to the facet: centres on an edge belong to both sides
  for (Index row = D == 2 ? 0 : first(low[1], grid.south, grid.dy, grid.rows);
       row <= (D == 2 ? 0 : std::min(grid.rows - 1, first(high[1], grid.south, grid.dy, grid.rows) + 1)); ++row)
    for (Index column = first(low[0], grid.west, grid.dx, grid.columns);
         column <= std::min(grid.columns - 1, first(high[0], grid.west, grid.dx, grid.columns) + 1); ++column) {
      const auto centre = grid.centre(column, row);
      const Vec<2> p = Vec<2>(centre[0], D == 2 ? Real{0} : centre[1]) - a;
      const Real s = (p[0] * ac[1] - p[1] * ac[0]) / area, t = (ab[0] * p[1] - ab[1] * p[0]) / area;
      if (s >= -rim && t >= -rim && s + t <= 1 + rim)
        f(grid.cell(column, row),
          (1 - s - t) * elevation(corner[0]) + s * elevation(corner[1]) + (D == 3 ? t * elevation(corner[D - 1]) : 0));
    }
}

}  // namespace talus
