#pragma once
// Small scenes that together have all that a run can have, for tests of what must hold for each.
#include "kernels/kernels.hpp"
#include "tests/app/scene_parts.hpp"

namespace talus {

/// Every law, kernel, transfer, boundary and kind of stage.
inline std::vector<SceneCase> scenes_of_all()
{
  const std::string solid = "dimension: 3\nmesh: {grid: {low: [0, 0, 0], high: [2, 2, 1], cells: [4, 4, 2]}}\n";
  std::vector<SceneCase> all;
  const auto law = [&](const std::string& name, const std::string& text) { all.push_back({"law_" + name, {.law = text}}); };
  for_each_type(Laws{}, [&]<class L>() { law(std::string(L::name), law_text(law_example<L>())); });
  law("neo_hookean_viscous", "law: neo_hookean, youngs_modulus: 1.0e6, poisson_ratio: 0.3, bulk_viscosity: {}");
  law("drucker_prager_softening", soil_law);
  law("drucker_prager_softening_length", soil_law + ", softening_length: 0.3");
  law("mohr_coulomb_varied",
      "law: mohr_coulomb, youngs_modulus: 1.0e6, poisson_ratio: 0.3, friction_angle: 30, cohesion: 2.0e3, variation: [{parameter: "
      "cohesion, "
      "coefficient_of_variation: 0.5, correlation_length: [0.5, 0.2]}, {parameter: youngs_modulus, coefficient_of_variation: 0.2, "
      "correlation_length: [0.4], correlated_with: cohesion, correlation: 0.5, trend: \"1 + 0.1 * y\"}]");
  law("mohr_coulomb_softening",
      "law: mohr_coulomb, youngs_modulus: 1.0e6, poisson_ratio: 0.3, friction_angle: 30, cohesion: 2.0e3, dilation_angle: 8, "
      "residual_friction_angle: 20, residual_cohesion: 500, softening_strain: 0.01, tension_cutoff: 2.0e3");
  law("johnson_cook_of_all",
      metal_law + ", damage: {d1: 0.01, d2: 0.1, d3: -1.5, d4: 0, d5: 0}, mie_gruneisen: {c0: 60, s: 1.5, gamma: 2}");
  law("johnson_cook_heat", metal_law + ", conductivity: 300, initial_temperature: 300");

  for_each_type(Kernels<2>{}, [&]<class K>() {
    for (const std::string scheme : {"apic", "aflip"})
      if (const std::string kernel(K::name); kernel != "projected")
        all.push_back({kernel + "_" + scheme, {.more = "kernel: " + kernel + "\ntransfer: {scheme: " + scheme + "}\n"}});
  });
  for (const std::string scheme : {"flip", "tpic", "saflip"})
    all.push_back({"projected_" + scheme, {.more = "transfer: {scheme: " + scheme + "}\n"}});
  all.push_back({"flip_without_musl", {.more = "transfer: {scheme: flip, musl: false}\n"}});
  all.push_back(
      {"averaged_volume",
       {.bodies =
            "bodies:\n  - {name: low, material: stuff, shape: {type: box, low: [0, 0], high: [1, 1]}, particles_per_cell: 3, velocity: [1, "
            "-3], f_bar: true}\n"}});
  all.push_back(
      {"averaged_metal",
       {.law = metal_law,
        .bodies =
            "bodies:\n  - {name: low, material: stuff, shape: {type: box, low: [0, 0], high: [1, 1]}, particles_per_cell: 3, velocity: [1, "
            "-9], f_bar: true}\n"}});
  all.push_back(
      {"tractions",
       {.bodies = "bodies:\n  - {name: low, material: stuff, shape: {type: box, low: [0, 0], high: [2, 2]}, particles_per_cell: 3}\n",
        .loads = "loads:\n  - {type: gravity, acceleration: [0, -9.81], table: [[0, 0], [0.03, 1], [1, 2]]}\n"
                 "  - {type: traction, on: x_max, traction: [-5.0e3, 0], table: [[0, 0], [0.02, 1], [1, 0]]}\n",
        .outputs = ", bodies: [low]"}});
  SceneParts surfaces{.bodies =
                          "bodies:\n"
                          "  - {name: low, material: stuff, shape: {type: box, low: [0.1, 0.1], high: [1.3, 0.9]}, particles_per_cell: 3, "
                          "velocity: [2, -1]}\n"
                          "  - {name: high, material: stuff, shape: {type: ring, centre: [1, 1.4], inner_radius: 0.2, radius: 0.5}, "
                          "particles_per_cell: 4}\n",
                      .loads =
                          "loads:\n  - {type: gravity, acceleration: [0, -9.81]}\n"
                          "  - {type: traction, on: \"low:x_max\", traction: [-5.0e3, 2.0e3], table: [[0, 0], [0.02, 1], [1, 0]]}\n"
                          "  - {type: traction, on: \"low:x_min\", pressure: 2.0e3}\n"
                          "  - {type: traction, on: \"high:inner\", pressure: 3.0e3}\n"
                          "  - {type: traction, on: \"high:boundary\", water_level: 1.6, unit_weight: 9.0e3}\n",
                      .outputs = ", bodies: [low, high]"};
  all.push_back({"surface_loads", surfaces});
  surfaces.more = "projected: {surfaces: extended}\n";
  all.push_back({"surface_loads_extended", surfaces});
  surfaces.more = "contacts: [{between: [low, high], friction: 0.3}]\n";
  all.push_back({"surface_loads_in_contact", surfaces});
  surfaces.more = "kernel: umls\ntransfer: {scheme: aflip}\n";
  all.push_back({"surface_loads_umls", surfaces});
  all.push_back(
      {"body_force",
       {.more = "on_exit: delete\n",
        .bodies =
            "bodies:\n"
            "  - {name: low, material: stuff, shape: {type: box, low: [0, 0], high: [1, 0.6]}, particles_per_cell: 3, velocity: [-9, 0]}\n"
            "  - {name: high, material: stuff, shape: {type: box, low: [0.3, 0.7], high: [1.2, 1.4]}, particles_per_cell: 4}\n",
        .boundaries = "boundaries: [{type: roller, on: y_min}]\n",
        .time = "stages:\n  - {type: run, duration: 0.02}\n  - {type: run, duration: 0.022, damping: 0.1}\n",
        .loads = "loads:\n  - {type: gravity, acceleration: [0, -9.81]}\n"
                 "  - {type: body_force, acceleration: [\"-20*x\", \"5*cos(40*t)\"]}\n",
        .outputs = ", bodies: [low, high]"}});
  all.push_back(
      {"moving_wall",
       {.boundaries =
            "boundaries: [{type: velocity, on: x_min, velocity: [2, 0], table: [[0, 0], [0.02, 1], [1, 0]]}, {type: fixed, on: y_min}, "
            "{type: fixed, on: x_max}, {type: fixed, on: y_max}]\n"}});
  all.push_back(
      {"deletion",
       {.more = "on_exit: delete\n",
        .bodies =
            "bodies:\n"
            "  - {name: low, material: stuff, shape: {type: box, low: [0, 0], high: [1, 0.6]}, particles_per_cell: 3, velocity: [-9, 0]}\n"
            "  - {name: high, material: stuff, shape: {type: box, low: [0.3, 0.7], high: [1.2, 1.4]}, particles_per_cell: 4, velocity: [9, "
            "0]}\n",
        .boundaries = "boundaries: [{type: roller, on: y_min}]\n"}});
  all.push_back(
      {"stages",
       {.law = soil_law,
        .bodies = "bodies:\n  - {name: low, material: stuff, shape: {type: box, low: [0, 0], high: [2, 1]}, particles_per_cell: 3}\n",
        .boundaries = "boundaries: [{type: fixed, on: y_min}, {type: roller, on: x_min}, {type: roller, on: x_max}]\n",
        .time =
            "stages:\n  - {type: geostatic, duration: 5, ramp: 0.05, ramp_shape: smooth, damping: 0.7, residual: 2.0e-2, initial_stress: "
            "{k0: 0.43}}\n"
            "  - {type: run, duration: 0.03}\n  - {type: run, duration: 0.04, damping: 0.2}\n"}});
  all.push_back(
      {"shaking",
       {.law = soil_law,
        .bodies = "bodies:\n  - {name: low, material: stuff, shape: {type: box, low: [0, 0], high: [2, 1.1]}, particles_per_cell: 3}\n",
        .boundaries = "boundaries:\n  - {type: free_field, on: x_min}\n  - {type: free_field, on: x_max}\n"
                      "  - {type: compliant_base, on: y_min, density: 2500, s_wave: 40, p_wave: 80, velocity: [0.2, 0.1], table: [[0, 0], "
                      "[0.02, 1], [0.04, 0]]}\n",
        .time = "stages:\n  - {type: geostatic, duration: 5, damping: 0.7, residual: 2.0e-2, initial_stress: {k0: 0.43}}\n"
                "  - {type: run, duration: 0.05}\n"}});
  all.push_back(
      {"water",
       {.more = "water: {table: {points: [[0, 0.9], [2, 0.4]]}, suction: 1.0e3, bodies: [low]}\n",
        .law = soil_law,
        .bodies = "bodies:\n"
                  "  - {name: low, material: stuff, shape: {type: box, low: [0, 0], high: [1, 1]}, particles_per_cell: 3, "
                  "saturated_density: 2100}\n"
                  "  - {name: high, material: stuff, shape: {type: box, low: [1, 0], high: [2, 1]}, particles_per_cell: 3}\n",
        .boundaries = "boundaries: [{type: fixed, on: y_min}, {type: roller, on: x_min}, {type: roller, on: x_max}]\n",
        .time = "stages:\n  - {type: geostatic, duration: 5, ramp: 0.05, residual: 5.0e-2, initial_stress: {from_friction: true, bodies: "
                "[{body: high, "
                "stress: {xx: -8.0e3, yy: -1.0e4, zz: -8.0e3, xy: 500}}]}}\n"
                "  - {type: run, duration: 0.02, water: {table: {points: [[0, 0.3], [2, 0.7]]}}}\n  - {type: run, duration: 0.02}\n"}});
  const SceneParts flow{
      .more =
          "water: {table: {depth: 0}, flow: {bodies: [{body: low, porosity: 0.4, permeability: 1.0e-3, kozeny_carman: true}, "
          "{body: high, porosity: 0.3, permeability: 1.0e-5, bulk_modulus: 1.0e8, biot: 0.9, "
          "retention: {entry: 2.0e3, exponent: 2, residual: 0.1}}], drained: [x_min], heads: [{on: x_max, "
          "level: 0.5, table: [[0, 1], [0.05, 1.4]]}], inflow: [{on: y_min, rate: 1.0e-4}]}}\n",
      .law = soil_law,
      .bodies =
          "bodies:\n"
          "  - {name: low, material: stuff, shape: {type: box, low: [0, 0], high: [1, 1]}, particles_per_cell: 3}\n"
          "  - {name: high, material: stuff, shape: {type: box, low: [1, 0], high: [2, 0.8]}, particles_per_cell: 3}\n",
      .boundaries = "boundaries: [{type: friction, on: y_min, coefficient: 0.3}, {type: roller, on: x_min}, {type: roller, on: x_max}]\n",
      .time =
          "stages:\n  - {type: geostatic, duration: 5, ramp: 0.05, residual: 5.0e-2}\n  - {type: run, duration: 0.05}\n"
          "  - {type: geostatic, duration: 5, residual: 8.0e-2}\n  - {type: run, duration: 0.02}\n"};
  all.push_back({"flow", flow});
  SceneParts pond = flow;  // one that sinks through the surface of both bodies
  pond.more =
      "water: {table: {elevation: 0.5}, flow: {bodies: [{body: low, porosity: 0.4, permeability: 1.0e-3}, {body: high, porosity: 0.3, "
      "permeability: 1.0e-5, retention: {entry: 2.0e3, exponent: 2, residual: 0.1}}], pond: {level: 1.3, table: [[0.05, 1], [0.2, 0.5]]}, "
      "rain: {rate: 2.0e-4}}}\n";
  all.push_back({"flow_pond", pond});
  SceneParts flow_umls = flow;
  flow_umls.more =
      "kernel: umls\n"
      "water: {table: {elevation: 0.5}, suction: 1.0e3, flow: {bodies: [{body: low, porosity: 0.4, permeability: 1.0e-4, "
      "retention: {entry: 1.0e3, exponent: 2}}, {body: high, porosity: 0.3, permeability: 1.0e-5, "
      "retention: {entry: 2.0e3, exponent: 2, residual: 0.1}}], heads: [{on: x_max, "
      "level: 0.5}], rain: {rate: 2.0e-4, table: [[0, 0], [0.1, 1]]}, pace: [[0, 20], [0.06, 1]]}}\n";
  all.push_back({"flow_umls", flow_umls});
  all.push_back(
      {"stages_that_change",
       {.law = soil_law + "}, {name: other, density: 2500, law: mohr_coulomb, youngs_modulus: 1.0e6, poisson_ratio: 0.3, "
                          "friction_angle: 30, cohesion: 4.0e3, bulk_viscosity: {}",
        .bodies =
            "bodies:\n"
            "  - {name: low, material: stuff, shape: {type: box, low: [0, 0], high: [1, 0.6]}, particles_per_cell: 3, velocity: [3, -1]}\n"
            "  - {name: stone, material: stuff, shape: {type: box, low: [1.3, 0], high: [2, 0.5]}, particles_per_cell: 3}\n"
            "  - {name: fill, material: other, shape: {type: box, low: [0, 1.3], high: [1, 1.9]}, particles_per_cell: 4, velocity: [1, "
            "-4], f_bar: true}\n",
        .boundaries = "boundaries: [{type: friction, on: y_min, coefficient: 0.3, gap: true, during: [one, three]}, {type: roller, on: "
                      "x_min, during: "
                      "[two]}, {type: fixed, on: x_max}, {type: fixed, on: y_max}]\n",
        .time = "time: {max_step: 1.4e-3}\nstages:\n  - {type: run, name: one, duration: 0.014}\n"
                "  - {type: run, name: two, duration: 0.0098, appear: [fill], change: [{body: low, material: other}]}\n"
                "  - {type: run, name: three, duration: 0.014, damping: 0.2, vanish: [stone], weaken: [{factor: 1.5}]}\n",
        .outputs =
            ", points: [{name: top, at: [0.5, 1.6], body: fill}], fronts: [{name: toe, direction: +x}], bodies: [fill, low, stone]"}});
  const SceneParts two_materials{
      .law = soil_law + "}, {name: other, density: 2500, law: neo_hookean, youngs_modulus: 5.0e6, poisson_ratio: 0.3",
      .bodies =
          "bodies:\n"
          "  - {name: low, material: stuff, shape: {type: box, low: [0, 0], high: [1.333, 0.667]}, particles_per_cell: 3, velocity: [3, "
          "-1]}\n"
          "  - {name: high, material: other, shape: {type: box, low: [0, 0.667], high: [1.333, 1.333]}, particles_per_cell: 4, velocity: "
          "[1, "
          "-2], "
          "f_bar: true}\n"
          "  - {name: right, material: stuff, shape: {type: box, low: [1.334, 0], high: [2, 1]}, particles_per_cell: 3}\n",
      .outputs = ", bodies: [low, high]"};
  all.push_back({"two_materials", two_materials});
  // Bodies that keep references, beside one that is renewed in each step; a body that never renews hangs alone.
  const std::string moving_bodies =
      "bodies:\n"
      "  - {name: low, material: stuff, shape: {type: box, low: [0, 0], high: [1, 0.6]}, particles_per_cell: 3, velocity: [3, -1], f_bar: "
      "true, reference: {update: adaptive}}\n"
      "  - {name: high, material: stuff, shape: {type: box, low: [0.3, 0.7], high: [1.2, 1.4]}, particles_per_cell: 4, velocity: [1, "
      "-4]}\n";
  const std::string hanging_body =
      "bodies: [{name: low, material: stuff, shape: {type: box, low: [0, 0.5], high: [2, 1.5]}, particles_per_cell: 3, velocity: [1, -1], "
      "reference: ";
  const std::string held = "boundaries: [{type: fixed, on: x_min}]\n";
  for (const auto& [name, kernel] : {std::pair<std::string, std::string>{"", ""},
                                     {"_linear", "kernel: linear\n"},
                                     {"_umls", "kernel: umls\n"},
                                     {"_exact_force", "kernel: umls\numls: {gradient: exact_force}\n"}}) {
    all.push_back({"references" + name, {.more = kernel, .bodies = moving_bodies}});
    all.push_back({"references_never" + name, {.more = kernel, .bodies = hanging_body + "{update: never}}]\n", .boundaries = held}});
  }
  all.push_back({"references_tpic", {.more = "transfer: {scheme: tpic}\n", .bodies = moving_bodies}});
  all.push_back({"references_by_volume", {.bodies = hanging_body + "{update: adaptive, volume_change: 1.0e-3}}]\n", .boundaries = held}});

  // A body that shear and impact draw apart, of which many are split and merged, beside one that is left alone.
  for (const auto& [name, law_of_body] : {std::pair<std::string, std::string>{"resampled", SceneParts{}.law}, {"resampled_soil", soil_law}})
    all.push_back(
        {name,
         {.law = law_of_body,
          .bodies =
              "bodies:\n"
              "  - {name: low, material: stuff, shape: {type: box, low: [0, 0], high: [1, 0.6]}, particles_per_cell: 3, velocity: [3 + 8 * "
              "y, -1], resample: {longest: 0.6, most: 5, every: 3}}\n"
              "  - {name: high, material: stuff, shape: {type: box, low: [0.3, 0.7], high: [1.2, 1.4]}, particles_per_cell: 4, velocity: "
              "[1, -4]}\n"}});

  SceneParts two_by_tpic = two_materials;
  two_by_tpic.more = "transfer: {scheme: tpic}\n";
  all.push_back({"two_materials_tpic", two_by_tpic});
  SceneParts contacts = two_materials;
  contacts.more =
      "contacts:\n  - {between: [low, high], friction: 0.3, cohesion: 100}\n  - {between: [right, low], friction: 0.1}\n"
      "  - {between: [high, right]}\n";
  all.push_back({"contacts", contacts});
  SceneParts contacts_tied = two_materials;
  contacts_tied.boundaries =
      "boundaries: [{type: friction, on: y_min, coefficient: 0.3, gap: true}, {type: friction, on: x_min, "
      "coefficient: 0, gap: true}, {type: fixed, on: x_max}]\n";
  contacts_tied.more = "kernel: umls\ncontacts:\n  - {between: [high, low], friction: 0.3}\n  - {between: [right, low], tied: true}\n";
  all.push_back({"contacts_umls", contacts_tied});
  SceneParts cuts = two_materials;
  cuts.dimension =
      "dimension: 2\nmesh: {grid: {low: [0, 0], high: [2, 2], cells: [6, 6]}, groups: [\n"
      "  {name: level, of: inside, within: {low: [-1, 0.99], high: [1.34, 1.01]}},\n"
      "  {name: upright, of: inside, within: {low: [0.99, -1], high: [1.01, 0.68]}}]}\n";
  cuts.bodies =
      "bodies:\n"
      "  - {name: low, material: stuff, shape: {type: box, low: [0, 0], high: [1, 1]}, particles_per_cell: 3, velocity: [3, -1]}\n"
      "  - {name: high, material: other, shape: {type: box, low: [0, 1], high: [1.4, 1.6]}, particles_per_cell: 4, velocity: [1, -2]}\n"
      "  - {name: right, material: stuff, shape: {type: box, low: [1, 0], high: [2, 1]}, particles_per_cell: 3}\n";
  cuts.more = "cuts:\n  - {on: level, friction: 0.3, cohesion: 100}\n  - {on: upright, friction: 0.1, tied_until: 0.02}\n";
  all.push_back({"cuts", cuts});
  cuts.more = "kernel: umls\ntransfer: {scheme: apic}\ncuts:\n  - {on: level, friction: 5}\n  - {on: upright, tied: true}\n";
  cuts.boundaries = "boundaries: [{type: roller, on: level}, {type: roller, on: y_min}, {type: friction, on: upright, coefficient: 0.2}]\n";
  all.push_back({"cuts_with_walls_umls", cuts});
  SceneParts rigid;
  rigid.more =
      "rigid:\n  - {name: disk, shape: {type: sphere, centre: [1.6, 0.32], radius: 0.3}, density: 1500, friction: 0.4, velocity: [-3, 0], "
      "angular_velocity: [5]}\n"
      "  - {name: stone, shape: {type: polygon, points: [[1.4, 1.1], [1.9, 1.2], [1.6, 1.5]]}, mass: 200, friction: 0.2, velocity: [-4, "
      "-4]}\n"
      "  - {name: ram, shape: {type: box, low: [0.2, 1.45], high: [1.1, 1.6]}, motion: given, velocity: [0, -6], angular_velocity: [-1], "
      "table: [[0, 0], [0.02, 1], [1, 0]], friction: 0.3}\n";
  all.push_back({"rigid", rigid});
  all.push_back({"rigid_linear", rigid});
  all.back().parts.more += "kernel: linear\n";
  rigid.more += "contacts: [{between: [low, high], friction: 0.3}]\nkernel: umls\n";
  all.push_back({"rigid_in_contact_umls", rigid});
  SceneParts sheet = two_materials;
  sheet.more =
      "rigid:\n  - {name: blade, sheet: [[0.8, 1.9], [0.75, 1.2], [0.7, 0.3]], motion: given, velocity: [2, -4], angular_velocity: [3], "
      "friction: 0.2}\n"
      "  - {name: flap, sheet: [[1.1, 0.55], [1.7, 0.5]], mass: 60, friction: 0.1, velocity: [-2, 3]}\n";
  all.push_back({"sheets", sheet});
  sheet.more += "kernel: umls\ntransfer: {scheme: apic}\n";
  all.push_back({"sheets_umls", sheet});
  sheet.law = soil_law + ", softening_length: 0.3" + two_materials.law.substr(soil_law.size());
  all.push_back({"sheets_softening_length", sheet});
  SceneParts extended = two_materials;
  extended.more = "projected: {surfaces: extended}\n";
  all.push_back({"extended", extended});
  SceneParts in_3d{.dimension = solid,
                   .law = soil_law,
                   .bodies =
                       "bodies:\n  - {name: low, material: stuff, shape: {type: box, low: [0, 0, 0], high: [1, 1, 1]}, "
                       "particles_per_cell: 4, velocity: "
                       "[2, -2, 1]}\n",
                   .boundaries = "boundaries: [{type: friction, on: y_min, coefficient: 0.3}, {type: roller, on: z_max}]\n",
                   .loads = "loads: [{type: gravity, acceleration: [0, -9.81, 0]}]\n",
                   .outputs = ", points: [{name: top, at: [1, 1, 1]}], fronts: [{name: toe, direction: +x}], bodies: [low]"};
  all.push_back({"solid", in_3d});
  SceneParts runs_out = in_3d;
  runs_out.outputs +=
      ", walls: [{on: y_min}]}\n  runout: {every: 0.004, frames_every: 0.02, cell: 0.3, moved: 0.01, threshold: 0.05, eroded: [low], csv: "
      "true, sections: "
      "[{name: axis, "
      "along: [[0, 0], [1, 2]]}]";
  all.push_back({"run_out", runs_out});
  SceneParts two_in_3d = in_3d;
  two_in_3d.law = two_materials.law;
  two_in_3d.bodies += "  - {name: high, material: other, shape: {type: box, low: [0, 1, 0], high: [1.4, 1.4, 1]}, particles_per_cell: 4}\n";
  all.push_back({"two_materials_solid", two_in_3d});
  two_in_3d.boundaries = "boundaries: [{type: friction, on: y_min, coefficient: 0.3, gap: true}, {type: roller, on: z_max}]\n";
  two_in_3d.more = "kernel: linear\ncontacts: [{between: [low, high], friction: 0.3}]\n";
  all.push_back({"contacts_solid", two_in_3d});
  SceneParts cuts_in_3d = two_in_3d;
  cuts_in_3d.dimension =
      "dimension: 3\nmesh: {grid: {low: [0, 0, 0], high: [2, 2, 1], cells: [4, 4, 2]}, groups: [\n"
      "  {name: level, of: inside, within: {low: [-1, 0.99, -1], high: [1.6, 1.01, 2]}}]}\n";
  cuts_in_3d.more = "cuts: [{on: level, friction: 0.3, cohesion: 50}]\n";
  all.push_back({"cuts_solid", cuts_in_3d});
  cuts_in_3d.more = "kernel: linear\ntransfer: {scheme: flip}\ncuts: [{on: level, friction: 0.3, tied_until: 0.02}]\n";
  all.push_back({"cuts_solid_linear", cuts_in_3d});
  two_in_3d.more = "projected: {surfaces: extended}\n";
  all.push_back({"extended_solid", two_in_3d});
  SceneParts rigid_in_3d = in_3d;
  rigid_in_3d.more =
      "rigid:\n  - {name: ball, shape: {type: sphere, centre: [1.3, 0.5, 0.5], radius: 0.25}, density: 1500, friction: 0.4, velocity: [-4, "
      "0, 0]}\n"
      "  - {name: drum, shape: {type: cylinder, from: [0.4, 1.2, 0.2], to: [0.6, 1.25, 0.8], radius: 0.15}, mass: 90, friction: 0.2, "
      "velocity: "
      "[3, -3, 0], angular_velocity: [1, 2, 3]}\n";
  all.push_back({"rigid_solid", rigid_in_3d});
  SceneParts sheet_in_3d = in_3d;
  sheet_in_3d.more =
      "rigid:\n  - {name: blade, sheet: [[0.5, 0.2, -0.2], [0.5, 1.4, -0.2], [0.55, 1.4, 0.6], [0.55, 0.2, 0.6]], motion: given, velocity: "
      "[3, 0, 0], angular_velocity: [0, 2, 0], friction: 0.3}\n";
  all.push_back({"sheet_solid", sheet_in_3d});
  SceneParts loaded_in_3d = in_3d;
  loaded_in_3d.loads =
      "loads: [{type: traction, on: \"low:x_max\", pressure: 2.0e3}, {type: traction, on: \"low:y_max\", traction: [1.0e3, 0, -500]}]\n";
  all.push_back({"surface_loads_solid", loaded_in_3d});
  SceneParts flow_in_3d = in_3d;
  flow_in_3d.more = "water: {flow: {bodies: [{body: low, porosity: 0.4, permeability: 1.0e-3}], drained: [x_min]}}\n";
  flow_in_3d.loads = "loads: [{type: gravity, acceleration: [0, 0, -9.81]}]\n";
  all.push_back({"flow_solid", flow_in_3d});
  flow_in_3d.more = "water: {table: {depth: 0}, flow: {bodies: [{body: low, porosity: 0.4, permeability: 1.0e-3}], pond: {level: 0.9}}}\n";
  all.push_back({"flow_pond_solid", flow_in_3d});
  in_3d.law = soil_law + ", softening_length: 0.3";
  all.push_back({"softening_length_solid", in_3d});
  in_3d.more = "kernel: umls\ntransfer: {scheme: apic}\n";
  in_3d.law = SceneParts{}.law;
  all.push_back({"solid_umls", in_3d});
  return all;
}

}  // namespace talus
