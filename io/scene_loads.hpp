#pragma once
// The blocks `loads` and `boundaries` of a scene.
#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "core/table.hpp"

namespace talus {

struct GravitySpec {
  static constexpr std::string_view name = "gravity";
  std::vector<Real> acceleration;
  Table table;
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{required("acceleration", &GravitySpec::acceleration, any, "m/s^2", "one number per dimension"),
                      optional("table", &GravitySpec::table, any, "-", "factor in time: list of [time, factor]")};
  }
};

enum class PlaceOf : std::uint8_t { now, start };
constexpr std::array<std::string_view, 2> words(PlaceOf) { return {"now", "start"}; }

/// Force per mass by formulas of place and time.
struct BodyForceSpec {
  static constexpr std::string_view name = "body_force";
  std::vector<std::string> acceleration;
  PlaceOf place = PlaceOf::now;
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{
        required("acceleration", &BodyForceSpec::acceleration, any, "m/s^2",
                 "force per mass: one number or formula of x, y, z and the time t per dimension, such as \"3 * sin(pi * x) * cos(8 * t)\""),
        optional_choice("place", &BodyForceSpec::place,
                        "x, y, z of a particle are where it is now or where it was at the start (for manufactured solutions)")};
  }
};

enum class Carrier : std::uint8_t { particles, mesh };
constexpr std::array<std::string_view, 2> words(Carrier) { return {"particles", "mesh"}; }

/// Force per area on a facet group: exactly one of traction and pressure.
struct TractionSpec {
  static constexpr std::string_view name = "traction";
  std::string on;
  std::vector<Real> traction;
  std::optional<Real> pressure;
  Carrier carried_by = Carrier::particles;
  Table table;
  Where where;
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

/// What every boundary says of the stages in which it acts.
inline constexpr std::string_view during_meaning = "names of the stages in which it acts; default all";

struct FixedSpec {
  static constexpr std::string_view name = "fixed";
  std::string on;
  std::vector<std::string> during;
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{required("on", &FixedSpec::on, any, "-", "node, facet or cell group held at rest"),
                      optional("during", &FixedSpec::during, any, "-", during_meaning)};
  }
};

struct RollerSpec {
  static constexpr std::string_view name = "roller";
  std::string on;
  std::vector<std::string> during;
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{required("on", &RollerSpec::on, any, "-", "facet group without normal motion; sliding is free"),
                      optional("during", &RollerSpec::during, any, "-", during_meaning)};
  }
};

struct VelocitySpec {
  static constexpr std::string_view name = "velocity";
  std::string on;
  std::vector<Real> velocity;
  Table table;
  std::vector<std::string> during;
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{required("on", &VelocitySpec::on, any, "-", "node, facet or cell group moved"),
                      required("velocity", &VelocitySpec::velocity, any, "m/s", "one number per dimension"),
                      optional("table", &VelocitySpec::table, any, "-", "factor in time: list of [time, factor]"),
                      optional("during", &VelocitySpec::during, any, "-", during_meaning)};
  }
};

struct FrictionSpec {
  static constexpr std::string_view name = "friction";
  std::string on;
  Real coefficient{};
  std::vector<std::string> during;
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{required("on", &FrictionSpec::on, any, "-", "facet group that acts as a wall: no penetration, free separation"),
                      required("coefficient", &FrictionSpec::coefficient, non_negative, "-",
                               "Coulomb friction coefficient, tangent of the wall friction angle"),
                      optional("during", &FrictionSpec::during, any, "-", during_meaning)};
  }
};

using BoundarySpec = std::variant<FixedSpec, RollerSpec, VelocitySpec, FrictionSpec>;

/// Names of the stages in which it acts; empty: all.
inline const std::vector<std::string>& during_of(const BoundarySpec& boundary)
{
  return std::visit([](const auto& spec) -> const std::vector<std::string>& { return spec.during; }, boundary);
}
/// Whether it acts in a stage of that name.
inline bool acts_in(const BoundarySpec& boundary, const std::string& stage)
{
  const auto& during = during_of(boundary);
  return during.empty() || std::find(during.begin(), during.end(), stage) != during.end();
}

}  // namespace talus
