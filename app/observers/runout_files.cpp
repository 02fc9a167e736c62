#include "app/observers/runout_files.hpp"

#include <fmt/format.h>

#include "io/system/traps.hpp"
#include "io/terrain/raster_file.hpp"

namespace talus {

Raster raster_of(const RunoutPlan& plan, const std::vector<Real>& values, std::string_view unit)
{
  const auto corner = plan.on_map({plan.grid.west, plan.grid.south});
  Raster raster;
  raster.columns = plan.grid.columns, raster.rows = plan.grid.rows;
  raster.west = corner[0], raster.south = corner[1];
  raster.dx = plan.grid.dx, raster.dy = plan.grid.dy;
  raster.values = values;
  raster.crs = plan.map ? plan.map->crs : "";
  raster.unit = unit;
  return raster;
}

void write_map(const std::filesystem::path& file, const Raster& raster)
{
  const TrapsPaused paused;
  write_raster(file, raster);
}

SectionPoints points_along(const std::vector<std::array<Real, 2>>& corners, Real step)
{
  Real begin = 0;
  SectionPoints points{{corners.front()}, {0}};
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const auto &a = corners[i], &b = corners[i + 1];
    const Real length = std::hypot(b[0] - a[0], b[1] - a[1]);
    const auto n = std::max(1, static_cast<int>(std::ceil(length / step - 1e-9)));
    for (int k = 1; k <= n; ++k) {
      const Real share = static_cast<Real>(k) / n;
      points.places.push_back({std::lerp(a[0], b[0], share), std::lerp(a[1], b[1], share)});
      points.distances.push_back(begin + share * length);
    }
    begin += length;
  }
  return points;
}

SectionPoints points_of_row(const PlanGrid& grid)
{
  SectionPoints points;
  for (Index column = 0; column < grid.columns; ++column) {
    points.places.push_back(grid.centre(column, 0));
    points.distances.push_back(points.places.back()[0] - grid.west);
  }
  return points;
}

std::string section_text(const RunoutPlan& plan, const std::vector<NamedMap>& maps, const SectionPoints& points)
{
  std::vector<CsvColumn> heads{{"distance", "m"}};
  const std::vector<std::string> axes = plan.axis_names();
  for (const std::string& axis : axes)
    heads.push_back({axis, "m"});
  for (const NamedMap& map : maps)
    heads.push_back({std::string(map.kind.name), std::string(map.kind.unit)});
  std::string text;
  for (std::size_t i = 0; i < heads.size(); ++i)
    text += (i > 0 ? "," : "") + csv_cell(csv_heading(heads[i]));
  text += '\n';
  const auto put = [&](Real value) { text += std::isnan(value) ? "," : fmt::format(",{}", value); };
  for (std::size_t i = 0; i < points.places.size(); ++i) {
    text += fmt::format("{}", points.distances[i]);
    const auto shown = plan.on_map(points.places[i]);
    for (std::size_t d = 0; d < axes.size(); ++d)
      put(shown[d]);
    for (const NamedMap& map : maps)
      put(sampled(plan.grid, map.values, points.places[i]));
    text += '\n';
  }
  return text;
}

}  // namespace talus
