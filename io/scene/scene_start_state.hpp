#pragma once
// The block `initial` of a body: a table of points with the state in which it starts.
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "core/fields.hpp"

namespace talus {

/// What happens to a quantity of particles that come from another run, or from a table.
enum class Carried : std::uint8_t { keep, zero };
constexpr std::array<std::string_view, 2> enum_names(Carried) { return {"keep", "zero"}; }

enum class StressSign : std::uint8_t { tension_positive, compression_positive };
constexpr std::array<std::string_view, 2> enum_names(StressSign) { return {"tension_positive", "compression_positive"}; }

enum class StressUnit : std::uint8_t { Pa, kPa, MPa };
constexpr std::array<std::string_view, 3> enum_names(StressUnit) { return {"Pa", "kPa", "MPa"}; }

enum class StressMeant : std::uint8_t { as_named, total, effective };
constexpr std::array<std::string_view, 3> enum_names(StressMeant) { return {"as_named", "total", "effective"}; }

enum class PointsOf : std::uint8_t { automatic, points, cells };
constexpr std::array<std::string_view, 3> enum_names(PointsOf) { return {"automatic", "points", "cells"}; }

/// The points of a table that are used.
struct SelectSpec {
  std::string column, value;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{required("column", &SelectSpec::column, any, "-", "name of a column, such as that of the material of an element"),
                      required("value", &SelectSpec::value, any, "-", "only points with this word or number there are used")};
  }
};

struct StartStateSpec {
  std::string table{};
  StressSign sign = StressSign::tension_positive;
  StressUnit unit = StressUnit::Pa;
  StressMeant stress = StressMeant::as_named;
  PointsOf data = PointsOf::automatic;
  std::optional<SelectSpec> select{};
  std::optional<Real> reach{};
  Carried velocity = Carried::keep, displacement = Carried::zero;
  SourceLocation where{};
  static constexpr auto fields()
  {
    return std::tuple{
        required("table", &StartStateSpec::table, any, "-",
                 "file of points with positions, stress and other values: text with a heading (.csv), or VTK's .vtu or .vtp; relative to "
                 "this file"),
        optional_choice("sign", &StartStateSpec::sign,
                        "compression_positive: the stress of the table is the negative of what Talus has, all components of it"),
        optional_choice("unit", &StartStateSpec::unit, "of stresses and pore pressures whose headings name no unit"),
        optional_choice("stress", &StartStateSpec::stress,
                        "as_named: effective in columns that are named so, otherwise total; or which of the two it is"),
        optional_choice("data", &StartStateSpec::data,
                        "of a .vtu: values at its points or at the centres of its cells; automatic: at points, where they have stress"),
        group("select", &StartStateSpec::select, "the points of this body, where the table has those of several; default all"),
        optional(
            "reach", &StartStateSpec::reach, positive, "m",
            "a particle may be as far from the nearest point; default as far as that point looks for its own neighbours, about one and "
            "a half spacings"),
        optional_choice("velocity", &StartStateSpec::velocity, "keep: of the table, where it has columns of it; zero: not from there"),
        optional_choice("displacement", &StartStateSpec::displacement,
                        "zero: counts from this start; keep: goes on from that of the table")};
  }
};

}  // namespace talus
