#include "app/observers/runout_columns.hpp"

#include "io/output/quantity.hpp"

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

}  // namespace talus
