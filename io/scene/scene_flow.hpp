#pragma once
// The group `flow` of the block `water`: how water flows through pores.
#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "core/time_table.hpp"

namespace talus {

/// A permeability of water in soil and rock [m/s] that is less than this is hardly meant: intrinsic permeabilities [m^2] are.
inline constexpr Real least_permeability = 1e-13;

/// Pores that drain under suction.
struct RetentionSpec {
  Real entry{}, exponent{}, residual = 0;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{
        required("entry", &RetentionSpec::entry, positive, "Pa", "suction at which pores begin to drain: 1/alpha of van Genuchten"),
        required("exponent", &RetentionSpec::exponent, {.low = 1}, "-",
                 "n of van Genuchten; the saturation is (1 + (s/entry)^n)^(1/n - 1)"),
        optional("residual", &RetentionSpec::residual, from_to_below(0, 1), "-", "saturation that no suction removes")};
  }
};

/// The pores of a body.
struct PoresSpec {
  std::string body;
  Real porosity{}, permeability{}, bulk_modulus = 2.2e9, biot = 1;
  bool kozeny_carman = false;
  std::optional<RetentionSpec> retention;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{
        required("body", &PoresSpec::body, any, "-", "name of a body, whose law then sees effective stress"),
        required("porosity", &PoresSpec::porosity, between(0, 1), "-",
                 "volume of pores over volume, at the start; it follows the deformation"),
        required("permeability", &PoresSpec::permeability, positive, "m/s",
                 "hydraulic conductivity k of Darcy's law: volume of water per area and time under a gradient of the head of 1"),
        optional("bulk_modulus", &PoresSpec::bulk_modulus, positive, "Pa", "of the water; less where it contains air"),
        optional("biot", &PoresSpec::biot, {.low = 0, .high = 1, .high_allowed = true}, "-",
                 "Biot's coefficient: total stress is effective stress minus this share of the pore pressure"),
        optional("kozeny_carman", &PoresSpec::kozeny_carman, any, "-",
                 "the permeability changes with the porosity n as n^3 / (1 - n)^2; default constant"),
        group("retention", &PoresSpec::retention, "how pores drain where the pressure is below zero; default they stay full")};
  }
};

/// A facet group with open water behind it.
struct HeadSpec {
  std::string on;
  Real level{};
  Table table;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{
        required("on", &HeadSpec::on, any, "-",
                 "facet group beside which there is water: the pore pressure is that of the depth below its level"),
        required("level", &HeadSpec::level, any, "m", "elevation of the surface of that water, whose weight presses on the facets"),
        optional("table", &HeadSpec::table, any, "-", "factor of the level in time: list of [time, factor]")};
  }
};

/// A facet group through which water flows in.
struct InflowSpec {
  std::string on;
  Real rate{};
  Table table;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{required("on", &InflowSpec::on, any, "-", "facet group through which water flows"),
                      required("rate", &InflowSpec::rate, any, "m/s", "volume per area and time, positive into the bodies"),
                      optional("table", &InflowSpec::table, any, "-", "factor in time: list of [time, factor]")};
  }
};

/// Rain on the surface of bodies as they move.
struct RainSpec {
  Real rate{};
  Table table;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{required("rate", &RainSpec::rate, positive, "m/s", "volume per horizontal area and time"),
                      optional("table", &RainSpec::table, any, "-", "factor in time: list of [time, factor]")};
  }
};

/// Open water on the surface of bodies as they move.
struct PondSpec {
  Real level{};
  Table table;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{required("level", &PondSpec::level, any, "m",
                               "elevation of the surface of that water: what lies below it is under water, whose weight presses on it"),
                      optional("table", &PondSpec::table, any, "-", "factor of the level in time: list of [time, factor]")};
  }
};

enum class SurfaceFlow : std::uint8_t { drained, impermeable };
constexpr std::array<std::string_view, 2> enum_names(SurfaceFlow) { return {"drained", "impermeable"}; }

struct FlowSpec {
  std::vector<PoresSpec> bodies;
  std::vector<std::string> drained;
  std::vector<HeadSpec> heads;
  std::vector<InflowSpec> inflow;
  std::optional<RainSpec> rain;
  std::optional<PondSpec> pond;
  Table pace;
  SurfaceFlow surface = SurfaceFlow::drained;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{
        required_list("bodies", &FlowSpec::bodies, "bodies through which water flows; all others are impermeable"),
        optional("drained", &FlowSpec::drained, any, "-", "facet groups at which the pore pressure is zero; other walls are impermeable"),
        optional_list("heads", &FlowSpec::heads, "facet groups with open water behind them"),
        optional_list("inflow", &FlowSpec::inflow, "facet groups through which a given volume of water flows in, such as rain"),
        group("rain", &FlowSpec::rain,
              "on the surface of the bodies as they move; what the soil cannot take up runs off. It needs pores with a retention"),
        group(
            "pond", &FlowSpec::pond,
            "open water on the surface of the bodies as they move, away from walls: below its level the pore pressure there is that of the "
            "depth, and the water presses on all bodies with its weight"),
        optional("pace", &FlowSpec::pace, any, "-",
                 "how many times faster water flows than permeabilities, inflow and rain say, in time: list of [time, factor]. Hours of "
                 "seepage then pass in seconds; give 1 from where soil begins to move"),
        optional_choice(
            "surface", &FlowSpec::surface,
            "of the bodies as they move, away from walls. drained: the pore pressure is zero there; impermeable: under a membrane")};
  }
  void check(std::vector<std::string>& problems) const
  {
    if (rain && surface == SurfaceFlow::impermeable)
      problems.emplace_back("rain falls on a surface that is drained: leave out rain, or surface: impermeable");
    if (rain && std::none_of(bodies.begin(), bodies.end(), [](const PoresSpec& one) { return one.retention.has_value(); }))
      problems.emplace_back(
          "all rain would run off, as pores without a retention are always full: give a body a retention, or leave out rain");
    if (std::any_of(pace.points.begin(), pace.points.end(), [](const auto& point) { return !(point[1] > 0); }))
      problems.emplace_back("the factors of pace are positive");
  }
};

}  // namespace talus
