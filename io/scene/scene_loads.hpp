#pragma once
// The block `loads` of a scene.
#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "core/time_table.hpp"

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

/// A force per area on a facet group: exactly one of traction and pressure.
struct TractionSpec {
  static constexpr std::string_view name = "traction";
  std::string on;
  std::vector<Real> traction;
  std::optional<Real> pressure;
  Carrier carried_by = Carrier::particles;
  Table table;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{
        required("on", &TractionSpec::on, any, "-", "facet group"),
        optional("traction", &TractionSpec::traction, any, "Pa", "force per initial area, fixed direction, one number per dimension"),
        optional("pressure", &TractionSpec::pressure, any, "Pa", "pressure normal to the surface as it deforms, positive pushes"),
        optional_choice(
            "carried_by", &TractionSpec::carried_by,
            "particles: the first layer of particles behind the facets carries the load and takes it along; mesh: the facets keep it"),
        optional("table", &TractionSpec::table, any, "-", "factor in time: list of [time, factor]")};
  }
  void check(std::vector<std::string>& problems) const;
};

using LoadSpec = std::variant<GravitySpec, BodyForceSpec, TractionSpec>;

}  // namespace talus
