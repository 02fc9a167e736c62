// What stages change: bodies that appear, vanish and become another material, strength that drops, walls that act in some stages only.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <regex>

#include "io/output/vtk.hpp"
#include "tests/app/program.hpp"

namespace talus::stages_test {
namespace {

using testing::HasSubstr;

constexpr Real gravity = 9.81;

class Stages : public Program {
 protected:
  void run(const std::string& scene) const
  {
    write("scene.yaml", scene);
    const Outcome outcome = talus("run scene.yaml --out out --threads 1");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    // Cells here are so large that particles and nodes lose much between them, and the run says so.
    const std::string other = without_losses(outcome.err);
    EXPECT_EQ(other.find("warning"), other.npos) << other;
  }
  /// Columns of the last row of each stage.
  std::vector<Real> at_ends_of_stages(std::string_view column) const
  {
    const HistoryTable table = history("out");
    const auto stage = table["stage"], values = table[column];
    std::vector<Real> ends;
    for (std::size_t row = 0; row < table.rows(); ++row)
      if (row + 1 == table.rows() || stage.value()[row + 1] != stage.value()[row])
        ends.push_back(values.value()[row]);
    return ends;
  }
  std::vector<std::filesystem::path> files_of_particles() const
  {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "out"))
      if (entry.path().extension() == ".vtp")
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
  }
  /// The sum of the numbers behind each place where the text has these words.
  static Real sum_behind(const std::string& words, const std::string& text)
  {
    Real sum = 0;
    for (auto at = text.find(words); at != text.npos; at = text.find(words, at + 1))
      sum += std::strtod(text.c_str() + at + words.size(), nullptr);
    return sum;
  }
  /// Mass and momentum close, and what the energy leaves open over the run is what its stages leave open: nothing is lost between them.
  void expect_closed_books() const
  {
    const std::string summary = read("out/summary.json");
    for (const std::string saved : {"mass", "momentum", "angular_momentum"}) {
      const auto begin = summary.find('"' + saved + "\": {");
      ASSERT_NE(begin, summary.npos) << saved;
      EXPECT_THAT(summary.substr(begin, summary.find('}', begin) - begin), HasSubstr("\"closes\": true")) << saved;
    }
    const Real scale = std::abs(sum_behind("\"gravity_work [J]\": ", summary));
    for (const std::string term : {"gravity_work", "energy_defect", "transfer_loss", "plastic"})
      EXPECT_NEAR(sum_behind("\"" + term + " [J]\": ", summary), sum_behind(": " + term + " [J]\": ", summary), 1e-6 * scale) << term;
  }
};

/// A column of soil between smooth walls, 2 m of ground, on which there may be up to 2 m more; moduli are those of confined compression.
constexpr Real modulus = 1e7, density = 2000;
std::string column(const std::string& bodies, const std::string& stages)
{
  return R"yaml(title: Column
dimension: 2
mesh: {grid: {low: [0, 0], high: [1, 4], cells: [2, 8]}}
materials:
  - {name: soil, law: linear_elastic, density: 2000, youngs_modulus: 1.0e7, poisson_ratio: 0}
  - {name: heavy, law: linear_elastic, density: 3000, youngs_modulus: 1.0e7, poisson_ratio: 0}
  - {name: rock, law: drucker_prager, density: 2000, youngs_modulus: 1.0e7, poisson_ratio: 0, friction_angle: 30, cohesion: 1.0e6,
     match: plane_strain}
  - {name: rubber, law: neo_hookean, density: 2000, youngs_modulus: 1.0e7, poisson_ratio: 0}
bodies:
  - {name: ground, material: soil, shape: {type: box, low: [0, 0], high: [1, 2]}, particles_per_cell: 6}
)yaml" + bodies +
         R"yaml(
loads: [{type: gravity, acceleration: [0, -9.81]}]
boundaries: [{type: roller, on: y_min}, {type: roller, on: x_min}, {type: roller, on: x_max}]
stages:
  - {type: geostatic, duration: 9, initial_stress: {k0: 0}, elastic: false}
)yaml" + stages +
         "outputs:\n  history: {every: 0.01, points: [{name: top, at: [0.5, 2], body: ground}, {name: floor, at: [0.5, 0], body: "
         "ground}]}\n";
}

/// Of so much soil on the ground [Pa], and how far the surface of the ground goes down under it [m].
Real weight(Real thickness) { return density * gravity * thickness; }
Real settlement(Real thickness) { return weight(thickness) * 2 / modulus; }

TEST_F(Stages, LiftsSettleTheGroundByTheirWeight)
{
  run(
      column("  - {name: lift_1, material: soil, shape: {type: box, low: [0, 2], high: [1, 3]}, particles_per_cell: 6}\n"
             "  - {name: lift_2, material: soil, shape: {type: box, low: [0, 3], high: [1, 4]}, particles_per_cell: 6}\n",
             "  - {type: geostatic, name: first, duration: 9, appear: [lift_1], elastic: false, reset_displacement: false}\n"
             "  - {type: geostatic, name: second, duration: 9, appear: [lift_2], elastic: false, reset_displacement: false}\n"));
  const auto mass = at_ends_of_stages("mass"), down = at_ends_of_stages("top_uy"), stress = at_ends_of_stages("floor_syy");
  ASSERT_EQ(mass.size(), 3U);
  EXPECT_NEAR(mass[0], 2 * density, 1e-6);
  EXPECT_NEAR(mass[1], 3 * density, 1e-6);
  EXPECT_NEAR(mass[2], 4 * density, 1e-6);
  EXPECT_NEAR(down[1], -settlement(1), 0.04 * settlement(1)) << "since the ground is at rest";
  EXPECT_NEAR(down[2], -settlement(2), 0.04 * settlement(2));
  EXPECT_NEAR(stress[1] - stress[0], -weight(1), 0.02 * weight(1));
  EXPECT_NEAR(stress[2] - stress[0], -weight(2), 0.02 * weight(2));
  expect_closed_books();
  const std::string summary = read("out/summary.json");
  for (const char* what : {"stage \\\"first\\\": body \\\"lift_1\\\" appears: ", "\"placed [kg]\": 4000.0", "\"name\": \"second\""})
    EXPECT_THAT(summary, HasSubstr(what));
}

TEST_F(Stages, AnExcavationRelievesTheGroundBelow)
{
  run(column("  - {name: cut, material: soil, shape: {type: box, low: [0, 2], high: [1, 4]}, particles_per_cell: 6}\n",
             "  - {type: geostatic, name: excavated, duration: 9, vanish: [cut], elastic: false, reset_displacement: false}\n"));
  const auto mass = at_ends_of_stages("mass"), up = at_ends_of_stages("top_uy"), stress = at_ends_of_stages("floor_syy");
  ASSERT_EQ(mass.size(), 2U);
  EXPECT_NEAR(mass[1], 2 * density, 1e-6);
  EXPECT_NEAR(up[1], settlement(2), 0.07 * settlement(2));
  EXPECT_NEAR(stress[1] - stress[0], weight(2), 0.02 * weight(2));
  expect_closed_books();
  EXPECT_THAT(read("out/summary.json"), HasSubstr("\"taken [kg]\": 4000.0"));
}

/// A stress that is in balance stays so under another law that can start from it; a heavier material weighs more.
TEST_F(Stages, ABodyGoesOnAsAnotherMaterial)
{
  run(column("",
             "  - {type: run, name: rock, duration: 0.2, change: [{body: ground, material: rock}]}\n"
             "  - {type: geostatic, name: heavy, duration: 9, change: [{body: ground, material: heavy}], elastic: false, "
             "reset_displacement: false}\n"));
  const auto mass = at_ends_of_stages("mass"), down = at_ends_of_stages("top_uy"), stress = at_ends_of_stages("floor_syy");
  ASSERT_EQ(mass.size(), 3U);
  EXPECT_EQ(mass[1], mass[0]);
  EXPECT_NEAR(down[1], 0, 0.02 * settlement(1));
  EXPECT_NEAR(stress[1] / stress[0], 1, 0.02);
  EXPECT_NEAR(mass[2], 1.5 * mass[0], 1e-6);
  EXPECT_NEAR(stress[2] / stress[0], 1.5, 0.05);
  EXPECT_NEAR(down[2] - down[1], -0.5 * settlement(1), 0.1 * settlement(1)) << "half the own weight, whose mean way is half the height";
  expect_closed_books();
}

/// What is placed late has no stress, or that of its own weight if the stage asks for it.
TEST_F(Stages, ABodyAppearsWithTheStressOfItsWeight)
{
  const auto first_stress = [&](const std::string& k0) {  // in the middle of the lift, before a wave comes there from its ends
    std::string scene = column("  - {name: lift, material: soil, shape: {type: box, low: [0, 2], high: [1, 4]}, particles_per_cell: 6}\n",
                               "  - {type: geostatic, name: built, duration: 9, appear: [lift]" + k0 + "}\n");
    const std::string point = "name: top, at: [0.5, 2], body: ground";
    scene.replace(scene.find(point), point.size(), "name: top, at: [0.5, 3], body: lift");
    run(scene);
    const HistoryTable table = history("out");
    const std::span<const Real> stress = *table["top_syy"];
    EXPECT_TRUE(std::isnan(stress.front())) << "it is not there yet";
    return *std::find_if(stress.begin(), stress.end(), [](Real value) { return std::isfinite(value); });
  };
  EXPECT_GT(first_stress(""), -0.1 * weight(1));
  EXPECT_LT(first_stress(", initial_stress: {k0: 0}"), -0.5 * weight(1));
}

/// A block of clay that stands, until it does not.
TEST_F(Stages, WeakenedGroundFails)
{
  run(R"yaml(title: Block
dimension: 2
mesh: {grid: {low: [0, 0], high: [6, 2], cells: [18, 6]}}
materials: [{name: clay, law: drucker_prager, density: 2000, youngs_modulus: 2.0e6, poisson_ratio: 0.3, friction_angle: 10, cohesion: 1.5e4,
  match: plane_strain}]
bodies: [{name: block, material: clay, shape: {type: box, low: [0, 0], high: [2, 2]}}]
loads: [{type: gravity, acceleration: [0, -9.81]}]
boundaries: [{type: fixed, on: y_min}, {type: roller, on: x_min}]
stages:
  - {type: geostatic, duration: 9}
  - {type: run, name: stands, duration: 0.4}
  - {type: run, name: trigger, duration: 0.8, weaken: [{factor: 4}]}
outputs: {history: {every: 0.02, fronts: [{name: toe, direction: +x}]}, particles: {every: 1, fields: [plastic_strain]}}
)yaml");
  const auto toe = at_ends_of_stages("toe");
  ASSERT_EQ(toe.size(), 3U);
  EXPECT_NEAR(toe[1], toe[0], 0.02);
  EXPECT_GT(toe[2], toe[1] + 0.3);
  expect_closed_books();
  EXPECT_THAT(read("out/summary.json"), HasSubstr("has its strength divided by 4"));
}

/// Sand behind a gate inside the mesh, an empty block of cells in its way.
const std::string gate_scene = R"yaml(title: Gate
dimension: 2
mesh:
  size: 0.2
  regions:
    - {name: full, shape: {type: box, low: [0, 0], high: [1, 1]}}
    - {name: block, shape: {type: box, low: [1.4, 0], high: [1.8, 0.4]}}
    - {name: air, shape: {type: polygon, points: [[1, 0], [1.4, 0], [1.4, 0.4], [1.8, 0.4], [1.8, 0], [3, 0], [3, 1.2], [0, 1.2], [0, 1], [1, 1]]}}
  groups: [{name: gate, of: "full:boundary", within: {low: [0.99, -0.1], high: [1.01, 1.1]}}]
materials: [{name: sand, law: drucker_prager, density: 1600, youngs_modulus: 4.0e5, poisson_ratio: 0.3, friction_angle: 25, cohesion: 0,
  match: plane_strain}]
bodies: [{name: pile, material: sand, region: full}]
loads: [{type: gravity, acceleration: [0, -9.81]}]
boundaries:
  - {type: friction, on: y_min, coefficient: 0.3}
  - {type: roller, on: x_min}
  - {type: roller, on: x_max}
  - {type: friction, on: gate, coefficient: 0, during: [filled]}
  - {type: friction, on: "block:boundary", coefficient: 0.3}
stages:
  - {type: run, name: filled, duration: 0.2}
  - {type: run, name: open, duration: 0.9}
outputs: {history: {every: 0.02, fronts: [{name: toe, direction: +x, mass_share: 1}]}, particles: {every: 0.1, fields: [velocity]}}
)yaml";

TEST_F(Stages, AGateOpensAndAnEmptyRegionStandsInTheWay)
{
  run(gate_scene);
  const auto toe = at_ends_of_stages("toe"), push = at_ends_of_stages("reaction_gate_x");
  ASSERT_EQ(toe.size(), 2U);
  EXPECT_LT(toe[0], 1.01);
  EXPECT_GT(toe[1], 1.35) << "it comes to the block";
  EXPECT_LT(push[0], -1000) << "the gate holds the sand";
  EXPECT_EQ(push[1], 0);
  expect_closed_books();
  Index inside = 0;
  const StoredParticles end = read_particles(files_of_particles().back());
  const std::vector<Real>& x = end.fields.at(0).values;
  for (std::size_t p = 0; p < end.ids.size(); ++p)
    inside += x[3 * p] > 1.42 && x[3 * p] < 1.78 && x[3 * p + 1] < 0.38 ? 1 : 0;
  EXPECT_EQ(inside, 0) << "in the block";
  EXPECT_THAT(read("out/summary.json"), HasSubstr("wall \\\"gate\\\" is gone"));
}

TEST_F(Stages, WhatCannotBeIsSaidWithItsPlace)
{
  const auto said = [&](const std::string& bodies, const std::string& stages) {
    write("scene.yaml", column(bodies, stages));
    const Outcome outcome = talus("check scene.yaml");
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    return outcome.err;
  };
  const std::string lift = "  - {name: lift, material: soil, shape: {type: box, low: [0, 1.5], high: [1, 3]}}\n";
  EXPECT_THAT(
      said(lift, "  - {type: run, name: built, duration: 1, appear: [lift]}\n"),
      testing::AllOf(HasSubstr("scene.yaml:18:5: error: stages[1] \"built\".appear: body \"lift\" cannot appear: other material is in its "
                               "place: 33.3 % of its volume in 4 cells"),
                     HasSubstr("the fullest at (")));
  EXPECT_THAT(said("", "  - {type: run, duration: 1, change: [{body: ground, material: rubber}]}\n"),
              HasSubstr("the body comes from law \"linear_elastic\", and law \"neo_hookean\" cannot start from its stress; of other laws"));
  EXPECT_THAT(said("", "  - {type: run, duration: 1, weaken: [{body: ground, factor: 2}]}\n"),
              HasSubstr("weaken[0].body: the law of body \"ground\" has no shear strength"));
  EXPECT_THAT(said("  - {name: lift, material: rubber, shape: {type: box, low: [0, 2], high: [1, 3]}}\n",
                   "  - {type: geostatic, duration: 1, appear: [lift], initial_stress: {k0: 1}}\n"),
              HasSubstr("law \"neo_hookean\" of body \"lift\" cannot start from a stress"));
}

/// The place is free at the start, and taken when the body comes.
TEST_F(Stages, ABodyThatFindsItsPlaceTakenStopsTheRun)
{
  write("scene.yaml", column("  - {name: stone, material: soil, shape: {type: box, low: [0, 3], high: [1, 3.5]}, velocity: [0, -5]}\n"
                             "  - {name: late, material: soil, shape: {type: box, low: [0, 2.5], high: [1, 3]}}\n",
                             "  - {type: run, name: late, duration: 0.05, appear: [late]}\n"));
  std::string scene = read("scene.yaml");
  const std::string first = "{type: geostatic, duration: 9, initial_stress: {k0: 0}, elastic: false}";
  scene.replace(scene.find(first), first.size(), "{type: run, duration: 0.05}");
  write("scene.yaml", scene);
  const Outcome outcome = talus("run scene.yaml --out out --quiet");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err,
              testing::AllOf(HasSubstr("stage \"late\" (scene.yaml:"), HasSubstr("body \"late\" cannot appear: other material")));
}

/// A strip is dug out and filled with something else: two bodies of one region, one after the other.
TEST_F(Stages, ABodyTakesThePlaceOfAnother)
{
  run(
      column("  - {name: old, material: soil, shape: {type: box, low: [0, 2], high: [1, 3]}, particles_per_cell: 6}\n"
             "  - {name: new, material: heavy, shape: {type: box, low: [0, 2], high: [1, 3]}, particles_per_cell: 6}\n",
             "  - {type: geostatic, duration: 9, vanish: [old], appear: [new], elastic: false, reset_displacement: false}\n"));
  const auto mass = at_ends_of_stages("mass");
  ASSERT_EQ(mass.size(), 2U);
  EXPECT_NEAR(mass[1] - mass[0], 1000, 1e-6);
  expect_closed_books();
}

}  // namespace
}  // namespace talus::stages_test
