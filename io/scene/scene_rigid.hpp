#pragma once
// The block `rigid` of a scene.
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "core/time_table.hpp"
#include "io/scene/shape.hpp"

namespace talus {

enum class RigidMotionKind : std::uint8_t { free, given };
constexpr std::array<std::string_view, 2> enum_names(RigidMotionKind) { return {"free", "given"}; }

/// A body that does not deform.
struct RigidSpec {
  std::string name;
  std::optional<Shape> shape;
  std::string file, sheet_file;
  std::vector<std::vector<Real>> sheet;
  std::vector<Real> at;
  std::optional<Real> mass, density;
  std::vector<Real> inertia;
  RigidMotionKind motion = RigidMotionKind::free;
  std::vector<Real> velocity, angular_velocity;
  Table table;
  Real friction = 0;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{
        required("name", &RigidSpec::name, any, "-", "name in messages and output"),
        optional("shape", &RigidSpec::shape, any, "-", "what it fills: a box, sphere, cylinder or polygon without holes"),
        optional("file", &RigidSpec::file, any, "-",
                 "3-D, instead of a shape: an STL file of its closed surface, in metres, relative to this file"),
        optional(
            "sheet", &RigidSpec::sheet, any, "m",
            "instead of a shape: a sheet without thickness, which parts the material on its two sides; in 2-D the points of a line, in "
            "3-D the corners of a flat convex polygon"),
        optional("sheet_file", &RigidSpec::sheet_file, any, "-",
                 "3-D, instead of a shape: an STL file of a sheet, whose surface is open, in metres, relative to this file"),
        optional("at", &RigidSpec::at, any, "m", "where the origin of the file lies; default the origin"),
        optional("mass", &RigidSpec::mass, positive, "kg",
                 "its mass, of unit thickness in 2-D; a free body needs mass or density, a free sheet mass"),
        optional("density", &RigidSpec::density, positive, "kg/m^3", "instead of a mass"),
        optional("inertia", &RigidSpec::inertia, positive, "kg m^2",
                 "moments of inertia about its centre: one number in 2-D, in 3-D those about x, y and z; default those of a uniform solid"),
        optional_choice("motion", &RigidSpec::motion,
                        "free: it moves as gravity and what it touches make it; given: it keeps velocity and angular_velocity, whatever it "
                        "touches, and rests without them"),
        optional("velocity", &RigidSpec::velocity, any, "m/s", "of its centre, one number per dimension: at the start, or the one given"),
        optional("angular_velocity", &RigidSpec::angular_velocity, any, "rad/s",
                 "about its centre, one number in 2-D (positive turns x to y), three in 3-D"),
        optional("table", &RigidSpec::table, any, "-", "of a given motion: factor of both in time, list of [time, factor]"),
        optional("friction", &RigidSpec::friction, non_negative, "-",
                 "Coulomb's coefficient with material and walls; between two rigid bodies the geometric mean of both")};
  }
  void check(std::vector<std::string>& problems) const;
  bool is_sheet() const noexcept { return !sheet.empty() || !sheet_file.empty(); }
  /// The key that says what it looks like.
  std::string_view key_of_shape() const noexcept
  {
    if (shape)
      return "shape";
    if (!sheet.empty())
      return "sheet";
    return file.empty() ? "sheet_file" : "file";
  }
};

}  // namespace talus
