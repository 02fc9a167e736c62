#include "io/terrain/surface_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/terrain/gdal_plugin.hpp"
#include "mesh/geometry/triangle_surface.hpp"

namespace talus {

MapBox extent_of(const std::vector<std::array<Real, 3>>& points)
{
  constexpr Real far = std::numeric_limits<Real>::infinity();
  MapBox box{far, far, -far, -far};
  for (const auto& [x, y, z] : points)
    box = {std::min(box.west, x), std::min(box.south, y), std::max(box.east, x), std::max(box.north, y)};
  return box;
}

Index merge_places(std::vector<std::array<Real, 3>>& points)
{
  std::sort(points.begin(), points.end());
  std::size_t saved = 0;
  for (std::size_t i = 0; i < points.size();) {
    std::size_t end = i;
    Real sum = 0;
    for (; end < points.size() && points[end][0] == points[i][0] && points[end][1] == points[i][1]; ++end)
      sum += points[end][2];
    points[saved] = points[i];
    points[saved++][2] = sum / static_cast<Real>(end - i);
    i = end;
  }
  const std::size_t merged = points.size() - saved;
  points.resize(saved);
  return static_cast<Index>(merged);
}

std::string merged_in_words(Index merged)
{
  return fmt::format("{} where another lies on the plan; each such place gets the mean of their elevations",
                     merged == 1 ? "1 point lies" : fmt::format("{} points lie", merged));
}

std::optional<SurfaceRead> over_triangles(std::vector<std::array<Real, 3>> points)
{
  const MapBox extent = extent_of(points);
  auto triangles = gdal().triangulate(points);
  if (triangles.empty())
    return std::nullopt;
  const Real spacing = std::sqrt((extent.east - extent.west) * (extent.north - extent.south) / static_cast<Real>(points.size()));
  return SurfaceRead{surface_of(TriangleSheet{std::move(points), std::move(triangles)}), "", extent, spacing};
}

namespace {

/// A line through points with increasing x.
Surface line_through(std::vector<std::vector<Real>> points)
{
  return [points = std::move(points)](const std::array<Real, 2>& place) {
    if (!(place[0] >= points.front()[0] && place[0] <= points.back()[0]))
      return std::numeric_limits<Real>::quiet_NaN();
    const auto next = std::upper_bound(points.begin() + 1, points.end() - 1, place[0], [](Real x, const auto& p) { return x < p[0]; });
    const auto &a = *(next - 1), &b = *next;
    const Real share = (place[0] - a[0]) / (b[0] - a[0]);
    return a[1] * (1 - share) + b[1] * share;
  };
}

}  // namespace

std::optional<SurfaceRead> read_given_points(const SurfaceSpec& spec, const MapPlan& plan, std::vector<SceneError>& problems,
                                             std::vector<std::string>& repairs)
{
  const std::size_t numbers = plan.is_line ? 2 : 3, fewest = numbers, before = problems.size();
  const auto complain = [&](const std::string& what) { problems.push_back({spec.where, what, {}}); };
  for (std::size_t i = 0; i < spec.points.size(); ++i)
    if (spec.points[i].size() != numbers)
      complain(fmt::format("point {} has {} numbers; here a point is {}", i + 1, spec.points[i].size(),
                           plan.is_line ? "[x, elevation]" : "[east, north, elevation]"));
    else if (plan.is_line && i > 0 && spec.points[i - 1].size() == numbers && !(spec.points[i][0] > spec.points[i - 1][0]))
      complain(
          fmt::format("x grows from point to point; point {} has {:.10g} after {:.10g}", i + 1, spec.points[i][0], spec.points[i - 1][0]));
  if (spec.points.size() < fewest)
    complain(fmt::format("{} points are needed at least", fewest));
  if (problems.size() > before)
    return std::nullopt;
  if (plan.is_line) {
    const MapBox extent{spec.points.front()[0], 0, spec.points.back()[0], 0};
    return SurfaceRead{line_through(spec.points), "", extent, 0};
  }
  std::vector<std::array<Real, 3>> points;
  for (const auto& point : spec.points)
    points.push_back({point[0], point[1], point[2]});
  if (const Index merged = merge_places(points); merged > 0)
    repairs.push_back(fmt::format("{}: {}", to_string(spec.where), merged_in_words(merged)));
  auto surface = over_triangles(std::move(points));
  if (!surface)
    complain("the points lie on one line, and span no surface");
  return surface;
}

}  // namespace talus
