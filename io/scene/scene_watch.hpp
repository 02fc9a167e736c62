#pragma once
// The block `watch` of a scene: limits of a run, and the action if one is exceeded.
#include <array>
#include <optional>
#include <string_view>

#include "core/fields.hpp"

namespace talus {

enum class LimitAction : std::uint8_t { stop, warn, ignore };
constexpr std::array<std::string_view, 3> enum_names(LimitAction) { return {"stop", "warn", "ignore"}; }

enum class OnFailure : std::uint8_t { stop, remove };
constexpr std::array<std::string_view, 2> enum_names(OnFailure) { return {"stop", "delete"}; }

struct LimitsSpec {
  std::optional<Real> speed;
  Real energy_gain = 0.9;
  LimitAction on_speed = LimitAction::stop, on_energy_gain = LimitAction::stop;
  OnFailure on_failure = OnFailure::stop;
  Real failed_mass = 1e-3;
  static constexpr auto fields()
  {
    return std::tuple{
        optional(
            "speed", &LimitsSpec::speed, positive, "m/s",
            "no particle should be faster; default 10 times the sum of what waves, velocities at the start, walls, gravity over the size "
            "of the mesh and tractions reach; with forces of place none"),
        optional_choice("on_speed", &LimitsSpec::on_speed, "what becomes of the run where one is"),
        optional("energy_gain", &LimitsSpec::energy_gain, positive, "-",
                 "kinetic and strain energy and dissipation should not outgrow what was there and what loads and walls did by more than "
                 "this share of the largest term of the stage's balance"),
        optional_choice("on_energy_gain", &LimitsSpec::on_energy_gain, "what becomes of the run where they do"),
        optional_choice("on_failure", &LimitsSpec::on_failure,
                        "what becomes of a particle that turns inside out or to which its law has no answer: it stops the run, or it is "
                        "deleted, with account of its mass"),
        optional("failed_mass", &LimitsSpec::failed_mass, within(0, 1), "-",
                 "share of the mass that may be deleted so before the run stops")};
  }
};

}  // namespace talus
