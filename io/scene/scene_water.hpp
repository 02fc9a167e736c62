#pragma once
// The block `water` of a scene.
#include <algorithm>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "io/scene/scene_surface.hpp"

namespace talus {

/// Pore water at rest below a constant table.
struct WaterSpec {
  SurfaceSpec table;
  Real unit_weight = 9810, suction = 0;
  std::vector<std::string> bodies, undrained;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{
        group("table", &WaterSpec::table, "the water table, where the pore pressure is zero; cut at the ground where it lies above"),
        optional("unit_weight", &WaterSpec::unit_weight, positive, "N/m^3", "pore pressure gained per metre below the table"),
        optional("suction", &WaterSpec::suction, non_negative, "Pa",
                 "largest suction above the table, up to which it grows as the pressure does below; 0 for none"),
        optional("bodies", &WaterSpec::bodies, any, "-",
                 "drained bodies: their laws see effective stress; those of the others see total stress, with undrained strengths. "
                 "Default all are drained"),
        optional("undrained", &WaterSpec::undrained, any, "-", "instead of bodies: those that are not drained")};
  }
  void check(std::vector<std::string>& problems) const
  {
    if (!bodies.empty() && !undrained.empty())
      problems.emplace_back("give bodies, which are drained, or undrained, not both");
  }
};

/// Whether the law of a body of that name uses effective stress.
inline bool is_drained(const WaterSpec& water, const std::string& body)
{
  const auto names = [&](const std::vector<std::string>& list) { return std::find(list.begin(), list.end(), body) != list.end(); };
  return (water.bodies.empty() || names(water.bodies)) && !names(water.undrained);
}

}  // namespace talus
