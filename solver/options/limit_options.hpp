#pragma once
// The block `watch` of a scene and its key `on_exit`: limits of a run, and what happens beyond them.
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include "core/fields.hpp"

namespace talus {

enum class LimitAction : std::uint8_t { stop, warn, ignore };
constexpr std::array<std::string_view, 3> enum_names(LimitAction) { return {"stop", "warn", "ignore"}; }

enum class OnFailure : std::uint8_t { stop, remove };
constexpr std::array<std::string_view, 2> enum_names(OnFailure) { return {"stop", "delete"}; }

struct LimitOptions {
  std::optional<Real> speed;
  Real energy_gain = 0.9;
  LimitAction on_speed = LimitAction::stop, on_energy_gain = LimitAction::stop;
  OnFailure on_failure = OnFailure::stop;
  Real failed_mass = 1e-3;
  static constexpr auto fields()
  {
    return std::tuple{
        optional(
            "speed", &LimitOptions::speed, positive, "m/s",
            "no particle should be faster; default 10 times the sum of what waves, velocities at the start, walls, gravity over the size "
            "of the mesh and tractions reach; with forces of place none"),
        optional_choice("on_speed", &LimitOptions::on_speed, "what becomes of the run where one is"),
        optional("energy_gain", &LimitOptions::energy_gain, positive, "-",
                 "kinetic and strain energy and dissipation should not outgrow what was there and what loads and walls did by more than "
                 "this share of the largest term of the stage's balance"),
        optional_choice("on_energy_gain", &LimitOptions::on_energy_gain, "what becomes of the run where they do"),
        optional_choice("on_failure", &LimitOptions::on_failure,
                        "what becomes of a particle that turns inside out or to which its law has no answer: it stops the run, or it is "
                        "deleted, with account of its mass"),
        optional("failed_mass", &LimitOptions::failed_mass, within(0, 1), "-",
                 "share of the mass that may be deleted so before the run stops")};
  }
};

/// The limits of a valid state; see solver/run_limits.hpp.
struct RunLimits {
  Real speed = std::numeric_limits<Real>::infinity();  ///< largest speed of any particle [m/s]
  Real gain = std::numeric_limits<Real>::infinity();   ///< energy gain without work, relative to the largest energy term [-]
  Real mass = 1e-9;                                    ///< mass lost between particles and nodes, relative to the total [-]
  Real least_energy = 0;                               ///< smaller gains are round-off [J]
  Real failed = 0;                                     ///< mass of failed particles that may be deleted, relative to the total [-]
  bool speed_stops = true, gain_stops = true;          ///< whether exceeding stops the run; otherwise it is only counted

  RunLimits() = default;
  /// `default_speed` [m/s] holds where the options give no speed.
  RunLimits(const LimitOptions& options, Real default_speed, Real round_off_energy)
      : least_energy(round_off_energy),
        speed_stops(options.on_speed == LimitAction::stop),
        gain_stops(options.on_energy_gain == LimitAction::stop)
  {
    if (options.on_speed != LimitAction::ignore)
      speed = options.speed.value_or(default_speed);
    if (options.on_energy_gain != LimitAction::ignore)
      gain = options.energy_gain;
    if (options.on_failure == OnFailure::remove)
      failed = options.failed_mass;
  }
};

/// What happens to a particle that leaves the mesh.
enum class OnExit : std::uint8_t { stop, remove };
constexpr std::array<std::string_view, 2> enum_names(OnExit) { return {"stop", "delete"}; }

}  // namespace talus
