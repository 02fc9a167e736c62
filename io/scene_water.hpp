#pragma once
// The block `water` of a scene.
#include <algorithm>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "io/scene_surface.hpp"

namespace talus {

/// Water at rest in the pores, below a table that stays where it is.
struct WaterSpec {
  SurfaceSpec table;
  Real unit_weight = 9810, suction = 0;
  std::vector<std::string> bodies;
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{
        group("table", &WaterSpec::table, "the water table, where the pore pressure is zero; cut at the ground where it lies above"),
        optional("unit_weight", &WaterSpec::unit_weight, positive, "N/m^3", "pore pressure gained per metre below the table"),
        optional("suction", &WaterSpec::suction, non_negative, "Pa",
                 "largest suction above the table, up to which it grows as the pressure does below; 0 for none"),
        optional("bodies", &WaterSpec::bodies, any, "-",
                 "drained bodies: their laws see effective stress; those of the others see total stress, with undrained strengths. "
                 "Default all are drained")};
  }
};

/// Whether the law of a body of that name sees effective stress.
inline bool is_drained(const WaterSpec& water, const std::string& body)
{
  return water.bodies.empty() || std::find(water.bodies.begin(), water.bodies.end(), body) != water.bodies.end();
}

}  // namespace talus
