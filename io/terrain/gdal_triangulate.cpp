#include <fmt/format.h>
#include <gdal_alg.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "io/terrain/gdal_part.hpp"
#include "io/terrain/gdal_session.hpp"

namespace talus::gdal_part {

namespace {

struct FreeTriangulation {
  void operator()(GDALTriangulation* triangulation) const noexcept { GDALTriangulationFree(triangulation); }
};

/// Whether points in the unit square lie on a line.
bool lie_on_a_line(const std::vector<double>& x, const std::vector<double>& y)
{
  std::size_t farthest = 0;
  const auto from_first = [&](std::size_t i) { return std::hypot(x[i] - x[0], y[i] - y[0]); };
  for (std::size_t i = 1; i < x.size(); ++i)
    if (from_first(i) > from_first(farthest))
      farthest = i;
  constexpr Real thin = 1e-9;  // relative to the extent
  for (std::size_t i = 1; i < x.size(); ++i)
    if (std::abs((x[farthest] - x[0]) * (y[i] - y[0]) - (x[i] - x[0]) * (y[farthest] - y[0])) > thin * from_first(farthest))
      return false;
  return true;
}

}  // namespace

std::vector<std::array<Index, 3>> triangulate(const std::vector<std::array<Real, 3>>& points)
{
  const GdalSession session;
  if (GDALHasTriangulation() == 0)
    throw EnvironmentError("GDAL was built without qhull and cannot triangulate points");
  if (points.size() < 3)
    return {};
  // Shifted to the origin and scaled to size one: map coordinates are so large that their products would lose the spacing of points.
  std::array<Real, 2> low{points[0][0], points[0][1]}, high = low;
  for (const auto& point : points)
    for (std::size_t d = 0; d < 2; ++d) {
      low[d] = std::min(low[d], point[d]);
      high[d] = std::max(high[d], point[d]);
    }
  const Real size = std::max(high[0] - low[0], high[1] - low[1]);
  std::vector<double> x(points.size()), y(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    x[i] = (points[i][0] - low[0]) / size;
    y[i] = (points[i][1] - low[1]) / size;
  }
  if (lie_on_a_line(x, y))  // qhull would print a long message
    return {};
  const std::unique_ptr<GDALTriangulation, FreeTriangulation> made(
      GDALTriangulationCreateDelaunay(static_cast<int>(points.size()), x.data(), y.data()));
  std::vector<std::array<Index, 3>> triangles;
  if (made == nullptr)
    return triangles;
  triangles.reserve(static_cast<std::size_t>(made->nFacets));
  for (int f = 0; f < made->nFacets; ++f) {
    const auto& nodes = made->pasFacets[f].anVertexIdx;  // NOLINT(cppcoreguidelines-pro-bounds-pointer-arithmetic)
    triangles.push_back({nodes[0], nodes[1], nodes[2]});
  }
  return triangles;
}

}  // namespace talus::gdal_part
