#pragma once
// The block `stages` of a scene.
#include <optional>
#include <string_view>
#include <variant>

#include "core/error.hpp"
#include "core/fields.hpp"

namespace talus {

/// Stress at the start: vertical stress from the weight above, horizontal stress k0 times it.
struct K0Spec {
  Real k0{};
  static constexpr auto fields() { return std::tuple{required("k0", &K0Spec::k0, non_negative, "-", "horizontal over vertical stress")}; }
};

/// Finds the state at rest under the loads: gravity ramp and local damping until the unbalanced force is small.
struct GeostaticSpec {
  static constexpr std::string_view name = "geostatic";
  Real duration{}, ramp = 0, damping = 0.7, residual = 1e-3;
  bool elastic = true, reset_displacement = true;
  std::optional<K0Spec> initial_stress;
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{
        required("duration", &GeostaticSpec::duration, positive, "s", "the stage fails if the residual is not reached by then"),
        optional("ramp", &GeostaticSpec::ramp, non_negative, "s", "gravity and loads grow linearly over this time"),
        optional("damping", &GeostaticSpec::damping, from_to_below(0, 1), "-",
                 "local damping: share of the nodal force that opposes the motion"),
        optional("residual", &GeostaticSpec::residual, positive, "-",
                 "done when the unbalanced nodal force is below this share of the total load"),
        optional("elastic", &GeostaticSpec::elastic, any, "-", "suspend yielding during the stage"),
        optional("reset_displacement", &GeostaticSpec::reset_displacement, any, "-",
                 "displacement of later stages counts from the end of this one"),
        group("initial_stress", &GeostaticSpec::initial_stress, "K0 state to start from, for laws that can carry a prestress")};
  }
  void check(std::vector<std::string>& problems) const;
};

struct RunSpec {
  static constexpr std::string_view name = "run";
  Real duration{}, damping = 0;
  Where where;
  static constexpr auto fields()
  {
    return std::tuple{required("duration", &RunSpec::duration, positive, "s", "length of the stage"),
                      optional("damping", &RunSpec::damping, from_to_below(0, 1), "-", "local damping; 0 for anything that flows")};
  }
};

using StageSpec = std::variant<GeostaticSpec, RunSpec>;

}  // namespace talus
