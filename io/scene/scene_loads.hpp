#pragma once
// The blocks `loads` and `water` of a scene.
#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "core/time_table.hpp"
#include "io/scene/scene_flow.hpp"
#include "io/scene/scene_surface.hpp"

namespace talus {

struct GravitySpec {
  static constexpr std::string_view name = "gravity";
  std::vector<Real> acceleration;
  Table table;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{required("acceleration", &GravitySpec::acceleration, any, "m/s^2", "one number per dimension"),
                      optional("table", &GravitySpec::table, any, "-", "factor in time: list of [time, factor]")};
  }
};

enum class PlaceOf : std::uint8_t { now, start };
constexpr std::array<std::string_view, 2> enum_names(PlaceOf) { return {"now", "start"}; }

/// A force per mass by formulas of position and time.
struct BodyForceSpec {
  static constexpr std::string_view name = "body_force";
  std::vector<std::string> acceleration;
  PlaceOf place = PlaceOf::now;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{
        required("acceleration", &BodyForceSpec::acceleration, any, "m/s^2",
                 "force per mass: one number or formula of x, y, z and the time t per dimension, such as \"3 * sin(pi * x) * cos(8 * t)\": "
                 "see formulas"),
        optional_choice("place", &BodyForceSpec::place,
                        "x, y, z of a particle are where it is now or where it was at the start (for manufactured solutions)")};
  }
};

enum class Carrier : std::uint8_t { particles, mesh };
constexpr std::array<std::string_view, 2> enum_names(Carrier) { return {"particles", "mesh"}; }

/// A force per area on a facet group or a side of a body: exactly one of traction, pressure and water level.
struct TractionSpec {
  static constexpr std::string_view name = "traction";
  std::string on;
  std::vector<Real> traction;
  std::optional<Real> pressure, water_level;
  Real unit_weight = 9810;
  Carrier carried_by = Carrier::particles;
  Table table;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{
        required("on", &TractionSpec::on, any, "-",
                 "facet group, or BODY:SIDE, a side of the shape that a body fills, wherever it cuts cells: see sides of bodies"),
        optional("traction", &TractionSpec::traction, any, "Pa", "force per initial area, fixed direction, one number per dimension"),
        optional("pressure", &TractionSpec::pressure, any, "Pa", "pressure normal to the surface as it deforms, positive pushes"),
        optional("water_level", &TractionSpec::water_level, any, "m",
                 "instead of a pressure, on a side of a body: that of water outside, unit_weight times the depth below this height"),
        optional("unit_weight", &TractionSpec::unit_weight, positive, "N/m^3", "of that water"),
        optional_choice("carried_by", &TractionSpec::carried_by,
                        "of facets. particles: the first layer of particles behind them carries the load and takes it along; mesh: the "
                        "facets keep it"),
        optional("table", &TractionSpec::table, any, "-", "factor in time: list of [time, factor]")};
  }
  void check(std::vector<std::string>& problems) const;
};

using LoadSpec = std::variant<GravitySpec, BodyForceSpec, TractionSpec>;

/// Pore water: at rest below a constant table, or flowing.
struct WaterSpec {
  std::optional<SurfaceSpec> table;
  std::optional<FlowSpec> flow;
  Real unit_weight = 9810, suction = 0;
  std::vector<std::string> bodies, undrained;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{
        group("table", &WaterSpec::table,
              "the water table, where the pore pressure is zero; cut at the ground where it lies above. With flow: at the start; default "
              "none"),
        group("flow", &WaterSpec::flow, "water that flows through pores; default water at rest"),
        optional("unit_weight", &WaterSpec::unit_weight, positive, "N/m^3", "pore pressure gained per metre below the table"),
        optional("suction", &WaterSpec::suction, non_negative, "Pa",
                 "largest suction above the table, up to which it grows as the pressure does below; 0 for none. With flow: at the start"),
        optional("bodies", &WaterSpec::bodies, any, "-",
                 "drained bodies: their laws see effective stress; those of the others see total stress, with undrained strengths. "
                 "Default all are drained"),
        optional("undrained", &WaterSpec::undrained, any, "-", "instead of bodies: those that are not drained")};
  }
  void check(std::vector<std::string>& problems) const
  {
    if (!bodies.empty() && !undrained.empty())
      problems.emplace_back("give bodies, which are drained, or undrained, not both");
    if (!table && !flow)
      problems.emplace_back("missing key \"table\": the water table, where the pore pressure is zero");
    if (!table && flow && suction > 0)
      problems.emplace_back("suction grows with the height above the water table: give a table, or leave suction out");
  }
};

/// Whether the law of a body of that name uses effective stress.
inline bool is_drained(const WaterSpec& water, const std::string& body)
{
  const auto names = [&](const std::vector<std::string>& list) { return std::find(list.begin(), list.end(), body) != list.end(); };
  return (water.bodies.empty() || names(water.bodies)) && !names(water.undrained);
}

}  // namespace talus
