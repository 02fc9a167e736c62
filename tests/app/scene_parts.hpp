#pragma once
// The lines of small scenes of which tests make many.
#include <fmt/format.h>

#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "materials/law_examples.hpp"

namespace talus {

/// Two bodies that fall, bounce and slide; every line may be replaced.
struct SceneParts {
  std::string dimension = "dimension: 2\nmesh: {grid: {low: [0, 0], high: [2, 2], cells: [6, 6]}}\n";
  std::string more = "";  ///< kernel, transfer
  std::string law = "law: neo_hookean, youngs_modulus: 1.0e6, poisson_ratio: 0.3";
  std::string bodies = "";  ///< replaces both
  std::string boundaries =
      "boundaries: [{type: friction, on: y_min, coefficient: 0.3}, {type: roller, on: x_min}, {type: fixed, on: x_max}, {type: fixed, on: "
      "y_max}]\n";
  std::string time = "time: {end: 0.042, max_step: 1.4e-3}\n";
  std::string loads = "loads: [{type: gravity, acceleration: [0, -9.81]}]\n";
  std::string outputs = "";
  int steps_of_a_checkpoint = 4;

  std::string text() const
  {
    const std::string usual =
        "bodies:\n"
        "  - {name: low, material: stuff, shape: {type: box, low: [0, 0], high: [1, 0.6]}, particles_per_cell: 3, velocity: [3, -1]}\n"
        "  - {name: high, material: stuff, shape: {type: box, low: [0.3, 0.7], high: [1.2, 1.4]}, particles_per_cell: 4, velocity: [1, "
        "-4]}\n";
    return "title: Restart\n" + dimension + more + "materials: [{name: stuff, density: 2000, " + law + "}]\n" +
           (bodies.empty() ? usual : bodies) + loads + boundaries + time +
           "outputs:\n  checkpoint: {steps: " + std::to_string(steps_of_a_checkpoint) +
           ", keep: 1000}\n  particles: {every: 0.013}\n  mesh: {every: 0.02}\n  history: {every: 0.007" +
           (outputs.empty()
                ? ", points: [{name: top, at: [1, 1]}], fronts: [{name: toe, direction: +x}], moved: [{name: slid, mass_share: 0.9}]"
                : outputs) +
           "}\n";
  }
};

struct SceneCase {
  std::string name;
  SceneParts parts;
  friend std::ostream& operator<<(std::ostream& out, const SceneCase& c) { return out << c.name; }
};

/// The parameters of a law as they stand in a scene, but the density; pressures and moduli a tenth as large, so that a step is long.
template <class L>
std::string law_text(const L& law)
{
  std::string text = fmt::format("law: {}", L::name);
  for_each_field<L>([&]<class Field>(const Field& field) {
    const auto& value = law.*(field.member);
    using Value = std::decay_t<decltype(value)>;
    if constexpr (std::is_enum_v<Value>) {
      text += fmt::format(", {}: {}", field.key, enum_names(value)[static_cast<std::size_t>(value)]);
    } else if constexpr (std::is_same_v<Value, Real> || std::is_same_v<Value, std::optional<Real>>) {
      const std::optional<Real> number = value;
      if (number && field.key != "density")
        text += fmt::format(", {}: {}", field.key, field.unit == "Pa" ? *number / 10 : *number);
    }
  });
  return text;
}

inline const std::string soil_law =
    "law: drucker_prager, youngs_modulus: 1.0e6, poisson_ratio: 0.3, friction_angle: 30, cohesion: 2.0e3, match: plane_strain, "
    "dilation_angle: 8, residual_friction_angle: 20, residual_cohesion: 500, softening_strain: 0.01, tension_cutoff: 2.0e3";

inline const std::string metal_law =
    "law: johnson_cook, youngs_modulus: 1.0e7, poisson_ratio: 0.3, yield_stress: 5.0e3, hardening_coefficient: 2.0e4, "
    "hardening_exponent: "
    "0.3, "
    "rate_coefficient: 0.02, thermal_exponent: 1, room_temperature: 293, melting_temperature: 330, specific_heat: 0.5";

}  // namespace talus
