// Stages that solve for equilibrium.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/app/forged.hpp"
#include "tests/app/program.hpp"
#include "tests/app/same_state.hpp"

namespace talus::static_stage_test {
namespace {

using StaticStage = Program;

/// A soft column of 1 m by 6 m between rollers, on a mesh that does not follow its top.
std::string column(const std::string& stages, const std::string& rest = "")
{
  return R"(title: Column
dimension: 2
mesh: {grid: {low: [0, 0], high: [1, 8], cells: [2, 16]}}
materials: [{name: soft, law: hencky, density: 1000, youngs_modulus: 5.0e5, poisson_ratio: 0}]
bodies: [{name: column, material: soft, shape: {type: box, low: [0, 0], high: [1, 6.2]}, particles_per_cell: 6}]
loads: [{type: gravity, acceleration: [0, -10]}]
boundaries: [{type: fixed, on: y_min}, {type: roller, on: x_min}, {type: roller, on: x_max}]
stages:
)" + stages +
         "outputs: {history: {every: 1.0e-9, points: [{name: top, at: [0.5, 6.2]}]}, particles: {every: 1}" + rest + "}\n";
}

/// The settlement of the top of a column of that height under its weight where sigma = M ln F / F (nu = 0): F = exp(-W(p / M)).
Real settlement(Real height, Real weight, Real modulus)
{
  constexpr int n = 10000;
  Real sum = 0;
  for (int i = 0; i < n; ++i) {
    const Real p = weight * height * (i + 0.5) / n;
    Real F = 1;  // sigma F = M ln F with sigma = -p
    for (int k = 0; k < 50; ++k)
      F = std::exp(-p * F / modulus);
    sum += (1 - F) * height / n;
  }
  return sum;
}

TEST_F(StaticStage, FindsTheColumnUnderItsWeight)
{
  write("column.yaml", column("  - {type: static, increments: 4}\n"));
  const Outcome run = talus("run column.yaml --out run");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NEAR(-last(history("run"), "top_uy"), settlement(6.2, 1e4, 5e5), 0.02 * settlement(6.2, 1e4, 5e5));
  EXPECT_LT(last(history("run"), "residual"), 1e-3);
  EXPECT_LT(last(history("run"), "kinetic"), 1e-20);
}

/// What a scene of several stages has in a column of history.csv, from the beginning of the second one on.
std::vector<Real> behind_the_first_stage(const HistoryTable& table, std::string_view column)
{
  const std::span<const Real> stage = table["stage"].value(), values = table[column].value();
  return {values.begin() + (std::ranges::find(stage, 1) - stage.begin()), values.end()};
}

TEST_F(StaticStage, StaysAtRestInTheStageBehindIt)
{
  write("column.yaml", column("  - {type: static, increments: 4}\n  - {type: run, duration: 0.3}\n"));
  const Outcome run = talus("run column.yaml --out run");
  ASSERT_EQ(run.code, 0) << run.err;
  const HistoryTable table = history("run");
  const std::vector<Real> residual = behind_the_first_stage(table, "residual"), kinetic = behind_the_first_stage(table, "kinetic");
  ASSERT_GT(residual.size(), 10);
  EXPECT_LT(std::ranges::max(residual), 1e-5) << "without the stress of empty cells 8e-4, without short increments at the end 4e-3";
  EXPECT_LT(std::ranges::max(kinetic), 1e-12 * last(table, "gravity_work"));
}

/// A plate that is held at its left side and bends under its weight, on a mesh that its sides cut.  Small strains: the equations are linear.
std::string plate(const std::string& body, const std::string& stages)
{
  return R"(title: Plate
dimension: 2
mesh: {grid: {low: [0, 0], high: [5, 4], cells: [10, 8]}}
materials: [{name: steel, law: linear_elastic, density: 1000, youngs_modulus: 1.0e9, poisson_ratio: 0.3}]
bodies: [{name: plate, material: steel)" +
         body +
         R"(}]
loads: [{type: gravity, acceleration: [0, -10]}]
boundaries: [{type: fixed, on: x_min}]
outputs: {checkpoint: {at_end: true}, history: {every: 1.0e-9)" +
         (body.empty() ? "" : ", points: [{name: corner, at: [4.2, 3.3]}]") + "}}\nstages:\n" + stages;
}
const std::string plate_body = ", shape: {type: box, low: [0, 0.7], high: [4.2, 3.3]}, particles_per_cell: 6";
std::string static_stage(int increments)
{
  return "  - {type: static, unbalanced: 0.5, residual: 1.0e-10, increments: " + std::to_string(increments) + "}\n";
}

/// The stress against jumps of gradients is part of the state with which another run begins, on any number of ranks.
TEST_F(StaticStage, LeavesABalanceFromWhichOtherRunsBegin)
{
  write("plate.yaml", plate(plate_body, static_stage(2)));
  ASSERT_EQ(talus("run plate.yaml --out rest").code, 0);
  ASSERT_EQ(talus("run plate.yaml --out rest_of_three", launcher_of(3)).code, 0);
  const std::string on = "  - {type: run, duration: 0.02}\ninitial: {from: ";
  write("on.yaml", plate("", on + "rest}\n"));
  write("on_of_three.yaml", plate("", on + "rest_of_three}\n"));
  ASSERT_EQ(talus("run on.yaml --out one").code, 0);
  ASSERT_EQ(talus("run on.yaml --out three", launcher_of(3)).code, 0);
  EXPECT_EQ(read("one/history.csv"), read("three/history.csv"));
  ASSERT_EQ(talus("run on_of_three.yaml --out one_of_three").code, 0);
  const Real stored = last(history("rest"), "strain");
  for (const char* run : {"one", "one_of_three"}) {
    const HistoryTable table = history(run);
    EXPECT_LT(std::ranges::max(table["kinetic"].value()), 1e-8 * stored) << run;
    EXPECT_LT(std::ranges::max(table["residual"].value()), 1e-4) << run;
    EXPECT_LT(std::abs(last(table, "energy_defect")), 1e-2 * stored) << run;
  }
}

/// Cells change their rank every third step: what empty cells have goes with them.
TEST_F(StaticStage, LeavesABalanceThatStaysWhenCellsChangeTheirRank)
{
  write("plate.yaml", plate(plate_body, static_stage(2) + "  - {type: run, duration: 0.02}\n"));
  const Outcome run = talus("run plate.yaml --out run --rebalance 3", launcher_of(3));
  ASSERT_EQ(run.code, 0) << run.err;
  const std::vector<Real> residual = behind_the_first_stage(history("run"), "residual");
  ASSERT_GT(residual.size(), 6);
  EXPECT_LT(std::ranges::max(residual), 1e-4) << "without the stress of empty cells 0.05";
}

TEST_F(StaticStage, RefusesACheckpointWithCellsThatTheMeshDoesNotHave)
{
  write("plate.yaml", plate(plate_body, static_stage(1) + "  - {type: run, duration: 0.001}\n"));
  ASSERT_EQ(talus("run plate.yaml --out run").code, 0);
  const auto saved = files_in(folder_ / "run/checkpoints", ".h5");
  ASSERT_FALSE(saved.empty());
  const std::filesystem::path file = saved.back();
  forge_value(file, "empty_cells/cell", 0, 1e6);
  const Outcome on = talus("run --out on --resume '" + saved.back().string() + "'");
  EXPECT_EQ(on.code, 3) << on.err;
  EXPECT_NE(on.err.find("its cells without particles do not fit the scene"), on.err.npos) << on.err;
}

/// A beam of 5 m by 1.1 m with nu = 0, whose end goes down by four cells.  Its particles move into cells that were empty before, so
/// the stiffness of an increment has to be that of the cells in which they lie then.
TEST_F(StaticStage, FollowsABeamThatBendsIntoEmptyCells)
{
  write("beam.yaml", R"(title: Beam
dimension: 2
mesh: {grid: {low: [0, -4], high: [6, 2], cells: [12, 12]}}
materials: [{name: rubber, law: neo_hookean, density: 1000, youngs_modulus: 1.2e7, poisson_ratio: 0}]
bodies: [{name: beam, material: rubber, shape: {type: box, low: [0, 0], high: [5, 1.1]}, particles_per_cell: 6}]
loads: [{type: traction, on: "beam:x_max", traction: [0, -6.4e4]}]
boundaries: [{type: fixed, on: x_min}]
stages: [{type: static, increments: 8, unbalanced: 1}]
outputs: {history: {every: 1.0e-9, points: [{name: tip, at: [5, 0.55]}]}}
)");
  const Outcome run = talus("run beam.yaml --out run");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(last(history("run"), "increment_cuts"), 0);
  const Real drop = 1.931;  // of beams with shear and stretch, P L^2 / (E I) = 1.322 (benchmarks/elastica/case.py)
  EXPECT_NEAR(-last(history("run"), "tip_uy"), drop, 0.1 * drop);  // two cells over the height: 5 % too soft
}

/// With the dilatation of single cells in the preconditioner no linear system is solved beyond a sixth of this load.
TEST_F(StaticStage, SolvesANearlyIncompressibleBlock)
{
  write("block.yaml", R"(title: Block
dimension: 2
mesh: {grid: {low: [0, -1], high: [5, 5], cells: [10, 12]}}
materials: [{name: rubber, law: neo_hookean, density: 1000, youngs_modulus: 1.0e6, poisson_ratio: 0.499}]
bodies: [{name: block, material: rubber, shape: {type: box, low: [0, 0], high: [4, 4.1]}, particles_per_cell: 6, f_bar: true}]
loads: [{type: traction, on: "block:x_max", traction: [0, 2.0e4]}]
boundaries: [{type: fixed, on: x_min}]
stages: [{type: static, increments: 1, unbalanced: 0.1}]
outputs: {history: {every: 1.0e-9}}
)");
  const Outcome run = talus("run block.yaml --out run");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_LT(last(history("run"), "solve_residual"), 1e-8);
}

TEST_F(StaticStage, FindsTheSameInAnyNumberOfIncrements)
{
  write("one.yaml", plate(plate_body, static_stage(1)));
  write("many.yaml", plate(plate_body, static_stage(40)));
  ASSERT_EQ(talus("run one.yaml --out one").code, 0);
  ASSERT_EQ(talus("run many.yaml --out many").code, 0);
  const Real sag = -last(history("one"), "corner_uy");
  EXPECT_GT(sag, 1e-6);
  EXPECT_NEAR(-last(history("many"), "corner_uy"), sag, 1e-5 * sag) << "where the stress of empty cells begins anew, 1.3 %";
}

/// A block of clay between rough plates, pressed beyond its limit load.
std::string pressed(int increments)
{
  return R"(title: Block
dimension: 2
mesh: {grid: {low: [0, 0], high: [5, 2], cells: [10, 4]}}
materials: [{name: clay, law: von_mises, density: 2000, youngs_modulus: 1.0e8, poisson_ratio: 0.3, yield_stress: 1.7e5}]
bodies: [{name: block, material: clay, shape: {type: box, low: [0, 0], high: [3.8, 2]}, particles_per_cell: 6, f_bar: true}]
boundaries: [{type: fixed, on: y_min}, {type: roller, on: x_min}, {type: velocity, on: y_max, velocity: [0, -0.02]}]
outputs: {history: {every: 1.0e-9}}
stages: [{type: quasi_static, duration: 1, increments: )" +
         std::to_string(increments) + "}]\n";
}

TEST_F(StaticStage, FindsALimitLoadInAnyNumberOfIncrements)
{
  write("few.yaml", pressed(8));
  write("many.yaml", pressed(64));
  ASSERT_EQ(talus("run few.yaml --out few").code, 0);
  ASSERT_EQ(talus("run many.yaml --out many").code, 0);
  const auto limit = [&](const std::string& run) {
    const HistoryTable table = history(run);
    return -std::ranges::min(table["reaction_y_max_y"].value());
  };
  EXPECT_NEAR(limit("few"), limit("many"), 0.025 * limit("many"));
}

/// Kinetic energy aside, all of history.csv.
std::string two_stages()
{
  return column("  - {type: static, increments: 3}\n  - {type: run, duration: 0.05}\n", ", checkpoint: {steps: 1, keep: 100}");
}

/// Most cells of a thick tube are about to yield where an increment begins, so differences of trials there are no derivative.
TEST_F(StaticStage, FollowsATubeThatYieldsInManyIncrements)
{
  const Outcome run =
      talus("run '" TALUS_SOURCE_DIR "/benchmarks/equilibrium/cylinder.yaml' --out run --set mesh.size=0.25 --set stages[0].increments=40");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_LT(last(history("run"), "residual"), 1e-3);
}

TEST_F(StaticStage, GoesOnFromAnyIncrementToTheSameBits)
{
  write("column.yaml", two_stages());
  ASSERT_EQ(talus("run column.yaml --out whole --threads 1").code, 0);
  ASSERT_EQ(talus("run column.yaml --out parts --threads 2 --until 2").code, 4);  // stopped as asked
  const Outcome rest = talus("run --resume parts");
  ASSERT_EQ(rest.code, 0) << rest.err;
  EXPECT_EQ(read("whole/history.csv"), read("parts/history.csv"));
}

TEST_F(StaticStage, FindsOnTwoRanksWhatItFindsOnOne)
{
  write("column.yaml", column("  - {type: static, increments: 3, residual: 1.0e-11}\n"));
  ASSERT_EQ(talus("run column.yaml --out one").code, 0);
  const Outcome two = talus("run column.yaml --out two", launcher_of(2));
  ASSERT_EQ(two.code, 0) << two.err;
  const Real settled = last(history("one"), "top_uy");
  EXPECT_NEAR(last(history("two"), "top_uy"), settled, 1e-10 * std::abs(settled));
  EXPECT_NEAR(last(history("two"), "top_syy"), last(history("one"), "top_syy"), 1e-8 * 6.2e4);
}

/// A block at that height above a floor, under a force of `tilt` of its weight along it.
std::string block(Real tilt, Real low = 0)
{
  return "title: Block\ndimension: 2\n"
         "mesh: {grid: {low: [0, 0], high: [4, 2], cells: [16, 8]}}\n"
         "materials: [{name: stiff, law: neo_hookean, density: 1000, youngs_modulus: 1.0e7, poisson_ratio: 0.3}]\n"
         "bodies: [{name: block, material: stiff, shape: {type: box, low: [1, " +
         std::to_string(low) + "], high: [2, " + std::to_string(low + 0.7) +
         "]}, particles_per_cell: 6}]\n"
         "loads: [{type: gravity, acceleration: [" +
         std::to_string(10 * tilt) + ", -10]}]\n" +
         "boundaries: [{type: friction, on: y_min, coefficient: 0.4}]\n"
         "stages: [{type: static, increments: 4}]\noutputs: {history: {every: 0.25}}\n";
}

/// A block between a floor and a wall that moves: what the wall does is what the block stores, in any number of increments.
TEST_F(StaticStage, WallsDoTheWorkThatABlockStores)
{
  write("push.yaml", R"(title: Pushed block
dimension: 2
mesh: {grid: {low: [0, 0], high: [1, 1], cells: [4, 4]}}
materials: [{name: rubber, law: linear_elastic, density: 1000, youngs_modulus: 1.0e6, poisson_ratio: 0}]
bodies: [{name: block, material: rubber, shape: {type: box, low: [0, 0], high: [1, 1]}, particles_per_cell: 4}]
boundaries: [{type: roller, on: y_min}, {type: roller, on: x_min}, {type: velocity, on: y_max, velocity: [0, -0.001]}]
stages: [{type: quasi_static, duration: 1, increments: 5}]
outputs: {history: {every: 0.2}}
)");
  const Outcome run = talus("run push.yaml --out run");
  ASSERT_EQ(run.code, 0) << run.err;
  const Real stored = last(history("run"), "strain");
  EXPECT_NEAR(stored, 0.5, 0.005) << "E e^2 / 2";
  EXPECT_NEAR(last(history("run"), "wall_work"), stored, 1e-3 * stored);
}

TEST_F(StaticStage, KnowsCoulombFriction)
{
  write("block.yaml", block(0.3));
  const Outcome run = talus("run block.yaml --out run");
  ASSERT_EQ(run.code, 0) << run.err;
  const Real weight = 10 * last(history("run"), "mass");
  EXPECT_NEAR(last(history("run"), "reaction_y_min_y"), weight, 1e-6 * weight);
  EXPECT_NEAR(last(history("run"), "reaction_y_min_x"), -0.3 * weight, 1e-6 * weight);
}

TEST_F(StaticStage, SaysWhereAMechanismBegins)
{
  write("block.yaml", block(0.5));
  const Outcome run = talus("run block.yaml --out run");
  EXPECT_EQ(run.code, 1);
  EXPECT_NE(run.err.find("there is no equilibrium at"), run.err.npos) << run.err;
  EXPECT_NE(run.err.find("is at ("), run.err.npos) << run.err;
}

TEST_F(StaticStage, SaysThatNothingHoldsTheBodies)
{
  write("block.yaml", block(0, 1));
  const Outcome run = talus("run block.yaml --out run");
  EXPECT_EQ(run.code, 1);
  EXPECT_NE(run.err.find("no boundary holds the bodies"), run.err.npos) << run.err;
}

}  // namespace
}  // namespace talus::static_stage_test
