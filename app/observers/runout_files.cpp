#include "app/observers/runout_files.hpp"

#include <fmt/format.h>

#include "io/output/quantity.hpp"
#include "io/system/traps.hpp"
#include "io/terrain/raster_file.hpp"

namespace talus {

namespace {

/// The columns; each function is called with RunoutNumbers.  A vector is a position: two coordinates in the plan, and the elevation.
constexpr auto columns_of_runout()
{
  using enum QuantityKind;
  return std::tuple{
      quantity<vector>("front_", "m", "where the front is", [](const auto& now) { return now.front; }),
      quantity<number>("H", "m", "from the crown down to the front", [](const auto& now) { return now.height; }),
      quantity<number>("L", "m", "from the crown to the front, on the level", [](const auto& now) { return now.length; }),
      quantity<number>("H/L", "-", "mobility", [](const auto& now) { return over(now.height, now.length); }),
      quantity<vector>("centre_", "m", "centre of mass of what has moved", [](const auto& now) { return now.centre; }),
      quantity<number>("centre_H", "m", "how far it has come down", [](const auto& now) { return now.centre_height; }),
      quantity<number>("centre_L", "m", "how far it has come on the level", [](const auto& now) { return now.centre_length; }),
      quantity<number>("centre_H/L", "-", "mobility of the centre",
                       [](const auto& now) { return over(now.centre_height, now.centre_length); }),
      quantity<number>("volume", "m^D", "volume of what has moved", [](const auto& now) { return now.volume; }),
      quantity<number>("area", "m^(D-1)", "where it is thicker than the threshold", [](const auto& now) { return now.area; }),
      quantity<number>("mean_thickness", "m", "mean thickness there", [](const auto& now) { return now.mean; }),
      quantity<number>("largest_thickness", "m", "largest thickness", [](const auto& now) { return now.thickest; }),
      quantity<number>("largest_speed", "m/s", "speed of the fastest particle", [](const auto& now) { return now.fastest; }),
      quantity<number>("mean_speed", "m/s", "mean speed of the mass that has moved", [](const auto& now) { return now.mean_speed; }),
      quantity<number>("bulk_speed", "m/s", "speed that mass_share of that mass does not exceed", [](const auto& now) { return now.bulk; }),
      quantity<number>("kinetic", "J", "kinetic energy of what has moved", [](const auto& now) { return now.kinetic; })};
}

constexpr auto columns_of_erosion()
{
  return std::tuple{quantity<QuantityKind::number>("entrained", "m^D", "volume of eroded bodies that has moved",
                                                   [](const auto& now) { return now.entrained; })};
}

template <class F>
void for_each_runout_column(bool erodes, F&& f)
{
  for_each_quantity(columns_of_runout(), f);
  if (erodes)
    for_each_quantity(columns_of_erosion(), f);
}

}  // namespace

std::vector<std::string> RunoutPlan::axis_names() const
{
  constexpr std::string_view messages = "xyz";
  if (map)
    return {"east", "north"};
  std::vector<std::string> names{std::string(1, messages[static_cast<std::size_t>(axes.plan[0])])};
  if (dimension == 3)
    names.emplace_back(1, messages[static_cast<std::size_t>(axes.plan[1])]);
  return names;
}

std::vector<CsvColumn> runout_columns(const RunoutPlan& plan, bool erodes)
{
  std::vector<CsvColumn> all{{"time", "s"}};
  for_each_runout_column(erodes, [&]<QuantityKind kind, class Value>(const Quantity<kind, Value>& column) {
    std::vector<std::string> components{""};
    if (kind == QuantityKind::vector) {
      components = plan.axis_names();
      components.emplace_back("elevation");
    }
    for (const std::string& component : components)
      all.push_back({std::string(column.name) + component, unit_in(plan.dimension, column.unit)});
  });
  return all;
}

std::vector<Real> runout_row(Real time, const RunoutNumbers& now, const RunoutPlan& plan, bool erodes)
{
  std::vector<Real> row{time};
  for_each_runout_column(erodes, [&]<QuantityKind kind, class Value>(const Quantity<kind, Value>& column) {
    const auto value = value_of<3>(column, now);
    if constexpr (kind == QuantityKind::vector) {
      const auto shown = plan.on_map(plan.on_plan(value));
      row.insert(row.end(), shown.begin(), shown.begin() + static_cast<std::ptrdiff_t>(plan.axis_names().size()));
      row.push_back(plan.elevation(value));
    } else {
      row.push_back(value);
    }
  });
  return row;
}

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
  std::string text = csv_header(heads);
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
