#include <gmock/gmock.h>

#include <numbers>
#include <regex>

#include "tests/app/program.hpp"

namespace talus::run_test {

namespace {

using testing::HasSubstr;

const std::string bar_scene = R"yaml(title: Small bar
dimension: 2
mesh: {grid: {low: [0, 0], high: [12, 1], cells: [24, 2]}}
time: {end: 1}
materials: [{name: rubber, law: linear_first_piola, density: 1, youngs_modulus: 100, poisson_ratio: 0}]
bodies:
  - {name: bar, material: rubber, shape: {type: box, low: [0, 0], high: [10, 1]}, particles_per_cell: 6, velocity: ["0.1 * sin(pi * x / 20)", "0"]}
boundaries: [{type: fixed, on: x_min}, {type: roller, on: y_min}, {type: roller, on: y_max}]
outputs:
  particles: {every: 0.25, fields: [velocity, stress, F, volume]}
  mesh: {every: 0.5, fields: [mass, velocity, force, reaction]}
  history: {every: 0.05, points: [{name: tip, at: [10, 0.5]}], fronts: [{name: reach, direction: +x, mass_share: 1}]}
)yaml";

class Run : public Program {};

TEST_F(Run, BarSwingsAsTheWaveEquationSays)
{
  write("bar.yaml", bar_scene);
  const Outcome outcome = talus("run bar.yaml --quiet");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const HistoryTable table = history("runs/bar");
  constexpr Real length = 10, speed = 10, v0 = 0.1;
  const Real omega = std::numbers::pi * speed / (2 * length);
  EXPECT_NEAR(first(table, "mass"), 10.0, 1e-11);
  // int 1/2 rho v^2 over the bar; three-point sampling of a quarter sine per 0.5 m cell errs by far less than 0.1 %.
  EXPECT_NEAR(first(table, "kinetic"), 0.25 * length * v0 * v0, 1e-3 * 0.25 * length * v0 * v0);
  EXPECT_NEAR(last(table, "time"), 1.0, 1e-12);
  // The particle nearest to the end lies up to a cell inside it, where the mode is flat; 2 % covers the coarse mesh.
  EXPECT_NEAR(last(table, "tip_ux"), v0 / omega * std::sin(omega), 0.02 * v0 / omega);
  EXPECT_NEAR(last(table, "tip_uy"), 0, 1e-3 * v0 / omega);
  EXPECT_LT(std::abs(last(table, "energy_defect")), 1e-2 * first(table, "kinetic"));
  EXPECT_NEAR(last(table, "kinetic") + last(table, "strain"), first(table, "kinetic"), 2e-2 * first(table, "kinetic"));
  EXPECT_GT(last(table, "reach"), first(table, "reach"));
}

/// What the line of the audit says of the energy.
Real closure_told(const std::string& out)
{
  std::smatch found;
  return std::regex_search(out, found, std::regex(R"(energy (?:closes to|DOES NOT CLOSE:) ([-+.e0-9]+))")) ? std::stod(found[1]) : -1;
}

TEST_F(Run, TheAuditSaysHowWellEnergyCloses)
{
  write("bar.yaml", bar_scene);
  for (const bool musl : {false, true}) {
    const std::string folder = musl ? "musl" : "usl";
    const Outcome outcome = talus(fmt::format("run bar.yaml --out {} --set transfer.musl={}", folder, musl));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const HistoryTable table = history(folder);
    const Real defect = last(table, "energy_defect");
    const Real largest = std::max({first(table, "kinetic"), last(table, "kinetic"), last(table, "strain")});
    const Real open = std::abs(defect) / largest;
    EXPECT_NEAR(closure_told(outcome.out), open, 0.06 * open) << outcome.out;  // two digits are told
  }
}

TEST_F(Run, AChangeOfTwoLinesStaysAComment)
{
  write("bar.yaml", bar_scene);
  ASSERT_EQ(talus("run bar.yaml --quiet --out out --set time.end=0.01 --set 'title=\"a\n b\"'").code, 0);
  const std::string text = read("out/scene.yaml");
  ASSERT_EQ(text.substr(0, bar_scene.size()), bar_scene);
  EXPECT_EQ(text.substr(bar_scene.size()), "\n# Run with changes:\n#   --set 'time.end=0.01'\n#   --set 'title=\"a\n#    b\"'\n");
  EXPECT_EQ(talus("check out/scene.yaml").code, 0);
}

TEST_F(Run, LeavesEveryFileThatWasAskedFor)
{
  write("bar.yaml", bar_scene);
  const Outcome outcome = talus("run bar.yaml --out there");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const char* file : {"scene.yaml", "mesh.msh", "mesh.vtu", "summary.json", "history.csv", "particles.pvd", "particles_0000.vtp",
                           "particles_0004.vtp", "mesh.pvd", "mesh_0000.vtu"})
    EXPECT_TRUE(exists(std::string("there/") + file)) << file;
  EXPECT_FALSE(exists("there/particles_0005.vtp"));
  EXPECT_EQ(read("there/scene.yaml"), bar_scene);
  EXPECT_THAT(read("there/summary.json"), HasSubstr("\"status\": \"done\""));
  EXPECT_THAT(outcome.out, HasSubstr("open/largest"));
  EXPECT_THAT(outcome.out, HasSubstr("results in there"));
}

TEST_F(Run, GivesTheSameBitsForAnyNumberOfThreads)
{
  write("block.yaml", block_scene(R"yaml(time: {end: 0.05}
loads: [{type: gravity, acceleration: [0.3, -9.81]}]
boundaries: [{type: friction, on: y_min, coefficient: 0.3}]
outputs:
  particles: {every: 0.05, fields: [velocity, displacement, stress, velocity_gradient]}
  history: {every: 0.01}
)yaml"));
  for (const int threads : {1, 2, 4}) {
    const std::string run = "t" + std::to_string(threads);
    const Outcome outcome = talus("run block.yaml --quiet --out " + run + " --threads " + std::to_string(threads));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(read(run + "/history.csv"), read("t1/history.csv"));
    EXPECT_EQ(read(run + "/particles_0001.vtp"), read("t1/particles_0001.vtp"));
  }
}

TEST_F(Run, SetChangesTheScene)
{
  write("bar.yaml", bar_scene);
  const Outcome outcome = talus("run bar.yaml --quiet --set time.end=0.3 --set bodies[0].particles_per_cell=3 --set kernel=linear");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NEAR(last(history("runs/bar"), "time"), 0.3, 1e-12);
  EXPECT_THAT(read("runs/bar/summary.json"), HasSubstr("\"kernel\": \"linear\""));
}

TEST_F(Run, StopsWhenAParticleLeavesTheMeshAndSaysWhich)
{
  write("block.yaml", block_scene("time: {end: 2}\noutputs: {particles: {every: 0.1}, history: {every: 0.1}}\n", ", velocity: [2, 0]"));
  const Outcome outcome = talus("run block.yaml --quiet");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(
      outcome.err,
      testing::MatchesRegex(
          "error: step [0-9]+, t = 0\\.2[0-9]* s: particle [0-9]+ of \"block\" \\(block\\.yaml:6:5\\) at \\(2\\.0[0-9]*, [0-9.]+\\) is "
          "outside the mesh; "
          "extend the mesh, close its boundary with a wall, or set on_exit: delete; last good output runs/block/particles_0002\\.vtp; the "
          "state before it: talus run block\\.yaml "
          "--out runs/block --until [0-9]+\n"));
  EXPECT_THAT(read("runs/block/summary.json"), HasSubstr("\"status\": \"failed\""));
  EXPECT_THAT(read("runs/block/summary.json"), HasSubstr("is outside the mesh"));
}

TEST_F(Run, KeepsAccountOfDeletedMass)
{
  write("block.yaml", block_scene("time: {end: 0.5}\non_exit: delete\noutputs: {particles: {every: 0.1}, history: {every: 0.1}}\n",
                                  ", velocity: [2, 0]"));
  const Outcome outcome = talus("run block.yaml --quiet");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const HistoryTable table = history("runs/block");
  // The block has gone 1 m with its front 0.5 m from the boundary: half of it is outside, give or take a column of particles.
  EXPECT_NEAR(first(table, "mass"), 1000, 1e-9);
  EXPECT_NEAR(last(table, "mass"), 500, 130);
  EXPECT_THAT(read("runs/block/summary.json"), HasSubstr("\"particles_removed\": "));
  EXPECT_THAT(read("runs/block/summary.json"), testing::Not(HasSubstr("\"particles_removed\": 0\n")));
}

TEST_F(Run, GoesOnWhenTheLastParticleHasLeft)
{
  write("block.yaml", block_scene(R"yaml(time: {end: 2}
on_exit: delete
outputs:
  particles: {every: 0.5}
  history: {every: 0.1, points: [{name: tip, at: [1.5, 0.5]}], fronts: [{name: toe, direction: +x}]}
)yaml",
                                  ", velocity: [2, 0]"));
  const Outcome outcome = talus("run block.yaml --quiet");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const HistoryTable table = history("runs/block");
  for (const char* column : {"centre_x", "centre_y", "tip_x", "tip_sxx", "toe"}) {
    EXPECT_TRUE(std::isfinite(first(table, column))) << column;
    ASSERT_TRUE(table[column].has_value()) << column;
    EXPECT_TRUE(std::isnan(last(table, column))) << column;
  }
  for (const auto& [name, unit] : table.columns) {
    const bool of_particles = name.starts_with("centre_") || name.starts_with("tip_") || name == "toe";
    EXPECT_EQ(std::isnan(last(table, name)), of_particles) << name;
  }
  EXPECT_EQ(last(table, "mass"), 0);
  EXPECT_EQ(last(table, "kinetic"), 0);
  EXPECT_THAT(read("runs/block/history.csv"), testing::Not(HasSubstr("nan")));
  EXPECT_THAT(read("runs/block/summary.json"), HasSubstr("\"status\": \"done\""));
  EXPECT_THAT(read("runs/block/summary.json"), testing::Not(HasSubstr("null")));
  const Outcome picture = talus("render runs/block");
  EXPECT_EQ(picture.code, 0) << "of no particles: " << picture.err;
}

TEST_F(Run, SpinGivenByAFormulaIsWholeInTheFirstStep)
{
  for (const char* scheme : {"apic", "tpic"}) {
    write("spin.yaml", std::string(R"yaml(title: Spinning block
dimension: 2
kernel: umls
mesh: {grid: {low: [-1, -1], high: [1, 1], cells: [8, 8]}}
time: {end: 0.01}
materials: [{name: rubber, law: neo_hookean, density: 1000, youngs_modulus: 1.0e5, poisson_ratio: 0.3}]
bodies:
  - {name: block, material: rubber, shape: {type: box, low: [-0.5, -0.5], high: [0.5, 0.5]}, particles_per_cell: 3, velocity: ["-2 * y", "2 * x"]}
transfer: {scheme: )yaml") +
                           scheme +
                           R"yaml(}
outputs: {history: {every: 1.0e-9}}
)yaml");
    const Outcome outcome = talus("run spin.yaml --quiet");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const HistoryTable table = history("runs/spin");
    ASSERT_GE(table.rows(), 3u);
    ASSERT_EQ(table["step"].value()[1], 1);
    // Nothing pulls yet, and nodes that see a rigid rotation give it back: what is left is the round-off of the gradient, eps^(2/3).
    constexpr Real round_off = 1e-9;
    for (const char* column : {"angular_momentum_z", "kinetic"}) {
      const auto values = table[column].value();
      EXPECT_NEAR(values[1], values[0], round_off * values[0]) << scheme << ' ' << column;
    }
  }
}

TEST_F(Run, GeostaticStageEndsAtRestUnderItsOwnWeight)
{
  write("column.yaml", R"yaml(title: Column
dimension: 2
mesh: {grid: {low: [0, 0], high: [1, 2], cells: [4, 8]}}
materials: [{name: soil, law: hencky, density: 1000, youngs_modulus: 1.0e6, poisson_ratio: 0.25}]
bodies: [{name: column, material: soil, region: all, particles_per_cell: 3}]
loads: [{type: gravity, acceleration: [0, -10]}]
boundaries: [{type: roller, on: x_min}, {type: roller, on: x_max}, {type: fixed, on: y_min}]
stages:
  - {type: geostatic, duration: 5, ramp: 0.2, residual: 1.0e-3}
  - {type: run, duration: 0.02}
outputs: {history: {every: 0.1, points: [{name: low, at: [0.5, 0.5]}]}}
)yaml");
  const Outcome outcome = talus("run column.yaml --quiet");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const HistoryTable table = history("runs/column");
  EXPECT_LT(last(table, "time"), 5.0) << "the stage ends when the column is at rest";
  const Real weight_above = 1000 * 10 * (2 - last(table, "low_y"));
  EXPECT_NEAR(last(table, "low_syy"), -weight_above, 0.1 * weight_above);  // the stress of a cell is that of its centre, 0.08 m away
  EXPECT_NEAR(last(table, "low_sxx"), last(table, "low_syy") / 3, 0.05 * weight_above);  // nu / (1 - nu)
  EXPECT_LT(std::abs(last(table, "low_uy")), 1e-4) << "displacement counts from the state at rest";
  EXPECT_NEAR(last(table, "reaction_y_min_y"), 20000, 0.05 * 20000);
  EXPECT_THAT(read("runs/column/summary.json"), HasSubstr("\"at rest\""));
}

TEST_F(Run, GeostaticStageThatDoesNotComeToRestFails)
{
  write("block.yaml", block_scene(R"yaml(loads: [{type: gravity, acceleration: [0, -9.81]}]
boundaries: [{type: fixed, on: y_min}]
stages: [{type: geostatic, duration: 0.02}]
)yaml"));
  const Outcome outcome = talus("run block.yaml --quiet");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("stage \"geostatic\" (block.yaml:9:10) did not come to rest within 0.02 s"));
  EXPECT_THAT(outcome.err, HasSubstr("asked 0.001"));
}

TEST_F(Run, TractionPushesItsOwnWay)
{
  for (const char* carrier : {"particles", "mesh"}) {
    write("block.yaml", R"yaml(title: Pulled block
dimension: 2
mesh: {grid: {low: [0, 0], high: [1, 1], cells: [4, 4]}}
time: {end: 0.02}
on_exit: delete
materials: [{name: rubber, law: neo_hookean, density: 1000, youngs_modulus: 1.0e5, poisson_ratio: 0.3}]
bodies: [{name: block, material: rubber, region: all, particles_per_cell: 3}]
boundaries: [{type: fixed, on: y_min}]
loads: [{type: traction, on: y_max, traction: [100, 0], carried_by: )yaml" +
                            std::string(carrier) + R"yaml(}]
outputs: {history: {every: 0.01, points: [{name: top, at: [0.5, 1]}]}}
)yaml");
    const Outcome outcome = talus("run block.yaml --quiet");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const HistoryTable table = history("runs/block");
    const auto time = table["time"].value(), floor = table["reaction_y_min_x"].value();
    Real impulse = 100 * (0.02 - last(table, "dt") / 2);  // velocities are of the middle of the last step
    for (std::size_t row = 1; row < time.size(); ++row)
      impulse += floor[row] * (time[row] - time[row - 1]);
    EXPECT_NEAR(last(table, "momentum_x"), impulse, 2e-3 * impulse) << carrier << ": the surface stretches by a thousandth";
    EXPECT_GT(last(table, "top_ux"), 0) << carrier;
    EXPECT_GT(last(table, "load_work"), 0) << carrier;
  }
}

TEST_F(Run, PressurePushesInwards)
{
  write(
      "block.yaml",
      block_scene(
          "time: {end: 0.01}\nloads: [{type: traction, on: y_min, pressure: 100}]\non_exit: delete\noutputs: {history: {every: 0.01}}\n"));
  const Outcome outcome = talus("run block.yaml --quiet");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const HistoryTable table = history("runs/block");
  EXPECT_NEAR(last(table, "momentum_y"), 100 * (0.01 - last(table, "dt") / 2), 0.01) << "velocities are of the middle of the last step";
  EXPECT_THAT(outcome.err,
              HasSubstr("warning: block.yaml:8:9: 50 % of the area of \"y_min\" has no particles behind it and carries no load"));
}

TEST_F(Run, WallsInsideTheMeshFaceTheMaterial)
{
  for (const char* shelf : {"void:boundary", "room:boundary"}) {
    write("shelf.yaml", std::string(R"yaml(title: Block on a shelf inside the mesh
dimension: 2
mesh:
  size: 0.25
  regions:
    - {name: void, shape: {type: box, low: [0, 0], high: [2, 1]}}
    - {name: room, shape: {type: box, low: [0, 1], high: [2, 2]}}
  groups: [{name: shelf, of: ")yaml") +
                            shelf + R"yaml(", within: {low: [0.1, 0.9], high: [1.9, 1.1]}}]
time: {end: 0.4}
materials: [{name: rubber, law: neo_hookean, density: 1000, youngs_modulus: 1.0e5, poisson_ratio: 0.3}]
bodies: [{name: block, material: rubber, shape: {type: box, low: [0.5, 1], high: [1.5, 1.5]}, particles_per_cell: 3}]
boundaries: [{type: friction, on: shelf, coefficient: 0.5}]
loads: [{type: gravity, acceleration: [0, -10]}]
outputs: {history: {every: 0.1, points: [{name: tip, at: [1, 1.25]}]}}
)yaml");
    const Outcome outcome = talus("run shelf.yaml --quiet");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_GT(last(history("runs/shelf"), "tip_uy"), -0.1) << shelf << ": free fall is 0.8 m";
  }
}

TEST_F(Run, BodyForceFollowsItsFormula)
{
  // Half a unit of time of the acceleration t along x; the particles start at different y, and their place of the start is what counts.
  const auto scene = [](const std::string& place) {
    return block_scene("time: {end: 0.5}\nloads: [{type: body_force, acceleration: [t, \"x > 1 ? 0.5 : 0\"], place: " + place +
                           "}]\noutputs: {history: {every: 0.1}}\n",
                       ", velocity: [1, 0]");
  };
  write("start.yaml", scene("start"));
  write("now.yaml", scene("now"));
  for (const char* name : {"start", "now"}) {
    const Outcome outcome = talus(std::string("run --quiet ") + name + ".yaml");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  const HistoryTable start = history("runs/start"), now = history("runs/now");
  const Real mass = last(start, "mass");
  EXPECT_NEAR(last(start, "momentum_x"), mass * (1 + 0.5 * 0.5 * 0.5), 0.005 * mass);  // a step is 2 % of the time
  EXPECT_NEAR(last(start, "momentum_y"), 0.5 * mass * 0.5 * 0.5, 0.005 * mass) << "half of the mass starts beyond x = 1";
  EXPECT_GT(last(now, "momentum_y"), 1.5 * last(start, "momentum_y")) << "more and more of it passes x = 1";
  EXPECT_NEAR(last(start, "load_work"), last(start, "kinetic") + last(start, "strain") - first(start, "kinetic"),
              0.02 * last(start, "load_work"));
}

TEST_F(Run, QuickMakesAnySceneShort)
{
  write("bar.yaml", bar_scene);
  const Outcome outcome = talus("run bar.yaml --quick --set time.end=1000 --quiet");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const HistoryTable table = history("runs/bar");
  EXPECT_LT(last(table, "step"), 250);
  EXPECT_GT(last(table, "step"), 100);
  EXPECT_LT(table.rows(), 8u);
  EXPECT_THAT(read("runs/bar/summary.json"), HasSubstr("\"result\": \"quick\""));
}

TEST_F(Run, ReplacesTheResultsOfAnEarlierRunOnly)
{
  write("bar.yaml", bar_scene);
  ASSERT_EQ(talus("run bar.yaml --quiet --out there").code, 0);
  write("there/notes.txt", "mine");
  ASSERT_EQ(talus("run bar.yaml --quiet --out there --set time.end=0.25").code, 0);
  EXPECT_TRUE(exists("there/particles_0001.vtp"));
  EXPECT_FALSE(exists("there/particles_0002.vtp"));
  EXPECT_EQ(read("there/notes.txt"), "mine");

  std::filesystem::create_directory(folder_ / "other");
  write("other/history.csv", "mine");
  const Outcome outcome = talus("run bar.yaml --quiet --out other");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(outcome.err,
            "error: other is not empty and holds no results of an earlier run (no summary.json): choose another folder with --out\n");
  EXPECT_EQ(read("other/history.csv"), "mine");
}

TEST_F(Run, MomentumOfAClosedSystemIsAccountedFor)
{
  write("block.yaml", block_scene("time: {end: 0.05}\nloads: [{type: gravity, acceleration: [1, -2]}]\nboundaries: [{type: roller, on: "
                                  "y_min}]\noutputs: {history: {every: 0.05}}\n"));
  const Outcome outcome = talus("run block.yaml");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, testing::ContainsRegex("momentum closes to [0-9.]+e-1[0-9]"));
}

}  // namespace

}  // namespace talus::run_test
