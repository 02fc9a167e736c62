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
#include "core/time_table.hpp"
#include "io/scene/record_file.hpp"

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

/// Force per mass by formulas of place and time.
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

/// Force per area on a facet group: exactly one of traction and pressure.
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

/// What every boundary says of the stages in which it acts.
inline constexpr std::string_view during_meaning = "names of the stages in which it acts; default all";

struct FixedSpec {
  static constexpr std::string_view name = "fixed";
  std::string on;
  std::vector<std::string> during;
  SourceLocation where;
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
  SourceLocation where;
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
  std::optional<RecordSpec> record;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{
        required("on", &VelocitySpec::on, any, "-", "node, facet or cell group moved"),
        required("velocity", &VelocitySpec::velocity, any, "m/s", "one number per dimension; with a record its direction"),
        optional("table", &VelocitySpec::table, any, "-", "factor in time: list of [time, factor]"),
        group("record", &VelocitySpec::record,
              "motion from a file in the place of a table; it begins with the first stage that is not geostatic, and before there is none"),
        optional("during", &VelocitySpec::during, any, "-", during_meaning)};
  }
  void check(std::vector<std::string>& problems) const;
};

/// Dashpots to a halfspace, and the wave that comes up from it.
struct CompliantBaseSpec {
  static constexpr std::string_view name = "compliant_base";
  std::string on;
  Real density{}, s_wave{}, p_wave{};
  std::vector<Real> velocity;
  Table table;
  std::optional<RecordSpec> record;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{
        required("on", &CompliantBaseSpec::on, any, "-",
                 "facet group above a halfspace: held in geostatic stages, then it carries what it carried, waves leave through it and one "
                 "comes up"),
        required("density", &CompliantBaseSpec::density, positive, "kg/m^3", "of the halfspace"),
        required("s_wave", &CompliantBaseSpec::s_wave, positive, "m/s", "speed of shear waves in the halfspace"),
        required("p_wave", &CompliantBaseSpec::p_wave, positive, "m/s", "speed of pressure waves in the halfspace"),
        optional("velocity", &CompliantBaseSpec::velocity, any, "m/s",
                 "of the particles in the wave that comes up, half of what an outcrop of the halfspace would show: one number per "
                 "dimension; with a record its direction; default none"),
        optional("table", &CompliantBaseSpec::table, any, "-",
                 "factor of velocity in time: list of [time, factor], from the beginning of the first stage that is not geostatic"),
        group("record", &CompliantBaseSpec::record, "motion from a file in the place of a table, from the same time on")};
  }
  void check(std::vector<std::string>& problems) const;
};

struct FrictionSpec {
  static constexpr std::string_view name = "friction";
  std::string on;
  Real coefficient{};
  std::vector<std::string> during;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{required("on", &FrictionSpec::on, any, "-", "facet group that acts as a wall: no penetration, free separation"),
                      required("coefficient", &FrictionSpec::coefficient, non_negative, "-",
                               "Coulomb friction coefficient, tangent of the wall friction angle"),
                      optional("during", &FrictionSpec::during, any, "-", during_meaning)};
  }
};

/// An upright side beside which the ground goes on level.
struct FreeFieldSpec {
  static constexpr std::string_view name = "free_field";
  std::string on;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{required("on", &FreeFieldSpec::on, any, "-",
                               "facet group of an upright side: a roller in geostatic stages, then level ground like that beside the side "
                               "goes on behind it, moved by the base of the model, and waves leave through it")};
  }
};

using BoundarySpec = std::variant<FixedSpec, RollerSpec, VelocitySpec, FrictionSpec, CompliantBaseSpec, FreeFieldSpec>;

/// Names of the stages in which it acts; empty: all, as always of those that give way to waves.
inline const std::vector<std::string>& during_of(const BoundarySpec& boundary)
{
  static const std::vector<std::string> all;
  return std::visit(
      [](const auto& spec) -> const std::vector<std::string>& {
        if constexpr (requires { spec.during; })
          return spec.during;
        else
          return all;
      },
      boundary);
}
/// Whether it acts in a stage of that name.
inline bool acts_in(const BoundarySpec& boundary, const std::string& stage)
{
  const auto& during = during_of(boundary);
  return during.empty() || std::find(during.begin(), during.end(), stage) != during.end();
}

}  // namespace talus
