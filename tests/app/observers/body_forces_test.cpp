// Bodies in the history: their momentum and energy, and the force of walls and other bodies on them.
#include "app/observers/body_forces.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "tests/app/program.hpp"

namespace talus::body_forces_test {
namespace {

using testing::HasSubstr;

class BodiesOfTheHistory : public Program {
 protected:
  HistoryTable run(const std::string& text, const std::string& name, const std::string& words = "", const std::string& launcher = "") const
  {
    write(name + ".yaml", text);
    const Outcome outcome = talus("run " + name + ".yaml --quiet --out " + name + " " + words, launcher);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return history(name);
  }
};

Real largest(std::span<const Real> values)
{
  Real most = 0;
  for (const Real value : values)
    most = std::max(most, std::abs(value));
  return most;
}

/// Nearly six cells are between the disks, more than two particles of `projected` reach over; they meet.
const std::string two_disks = R"yaml(title: Disks
dimension: 2
mesh: {grid: {low: [0, 0], high: [1, 1], cells: [16, 16]}}
time: {end: 0.6}
materials: [{name: rubber, law: neo_hookean, density: 1000, youngs_modulus: 1.0e4, poisson_ratio: 0.3}]
bodies:
  - {name: left, material: rubber, shape: {type: sphere, centre: [0.2, 0.5], radius: 0.12}, particles_per_cell: 4, velocity: [0.4, 0]}
  - {name: right, material: rubber, shape: {type: sphere, centre: [0.8, 0.55], radius: 0.12}, particles_per_cell: 4, velocity: [-0.4, 0]}
outputs: {history: {every: 0.02, bodies: [left, right]}}
)yaml";

TEST_F(BodiesOfTheHistory, TwoDisksPushEachOtherEquallyAndOppositely)
{
  const HistoryTable table = run(two_disks, "disks");
  for (const char* axis : {"x", "y"}) {
    const auto left = table[std::string("force_left_") + axis], right = table[std::string("force_right_") + axis];
    ASSERT_TRUE(left && right);
    const Real most = largest(*left);
    EXPECT_GT(most, 1) << "they have to meet";
    for (std::size_t i = 0; i < left->size(); ++i)
      EXPECT_NEAR((*left)[i], -(*right)[i], 1e-10 * most) << axis << ", row " << i;
  }
  const auto time = *table["time"], left = *table["force_left_x"];
  EXPECT_LT(std::ranges::min(left), -1) << "the left one is pushed to the left";
  for (std::size_t i = 0; i < time.size() && time[i] < 0.05; ++i)
    EXPECT_NEAR(left[i], 0, 1e-9) << "before they share a node there is no force";
}

TEST_F(BodiesOfTheHistory, TheImpulseOfTheForceIsTheChangeOfMomentum)
{
  const HistoryTable table = run(two_disks, "disks");
  const auto time = *table["time"], momentum = *table["momentum_left_x"], force = *table["force_left_x"];
  for (std::size_t i = 1; i < time.size(); ++i)
    EXPECT_NEAR(momentum[i] - momentum[i - 1], force[i] * (time[i] - time[i - 1]), 1e-11 * std::abs(momentum[0])) << i;
  EXPECT_NEAR(momentum[0], 0.4 * (*table["mass_left"])[0], 1e-12 * momentum[0]);
  EXPECT_NEAR((*table["kinetic_left"])[0], 0.5 * 0.4 * momentum[0], 1e-12 * momentum[0]);
  for (std::size_t i = 0; i < time.size(); ++i) {
    EXPECT_NEAR((*table["momentum_left_x"])[i] + (*table["momentum_right_x"])[i], (*table["momentum_x"])[i], 1e-12 * momentum[0]);
    EXPECT_NEAR((*table["kinetic_left"])[i] + (*table["kinetic_right"])[i], (*table["kinetic"])[i], 1e-12 * (*table["kinetic"])[0]);
  }
}

const std::string with_bodies = "outputs: {history: {every: 0.01, bodies: [block]}}\n";

TEST_F(BodiesOfTheHistory, NothingActsOnABlockThatFallsWhileGravityChanges)
{
  const HistoryTable table =
      run("title: Fall\ndimension: 2\nmesh: {grid: {low: [0, 0], high: [2, 4], cells: [8, 16]}}\ntime: {end: 0.2}\n"
          "materials: [{name: rubber, law: neo_hookean, density: 1000, youngs_modulus: 1.0e5, poisson_ratio: 0.3}]\n"
          "bodies: [{name: block, material: rubber, shape: {type: box, low: [0.5, 2], high: [1.5, 3]}, particles_per_cell: 3}]\n"
          "loads:\n"
          "  - {type: gravity, acceleration: [2, -10], table: [[0, 0], [0.1, 1], [0.2, 0.3]]}\n"
          "  - {type: body_force, acceleration: [\"sin(3 * x)\", \"t\"]}\n" +
              with_bodies,
          "fall");
  const Real weight = (*table["mass_block"])[0] * 10;
  EXPECT_LT(last(table, "momentum_block_y"), -0.05 * weight) << "it has to fall";
  EXPECT_LT(largest(*table["force_block_x"]), 1e-10 * weight);
  EXPECT_LT(largest(*table["force_block_y"]), 1e-10 * weight);
}

TEST_F(BodiesOfTheHistory, TheFloorCarriesWhatRestsOnIt)
{
  const HistoryTable table = run(block_scene("time: {end: 0.4}\nloads: [{type: gravity, acceleration: [0, -10]}]\n"
                                             "boundaries: [{type: friction, on: y_min, coefficient: 0.3}]\n" +
                                             with_bodies),
                                 "rest");
  const auto force = *table["force_block_y"], reaction = *table["reaction_y_min_y"];
  const Real weight = (*table["mass_block"])[0] * 10;
  Real mean = 0;
  for (std::size_t i = 1; i < force.size(); ++i) {
    EXPECT_NEAR(force[i], reaction[i], 1e-10 * weight) << i;
    mean += force[i] / static_cast<Real>(force.size() - 1);
  }
  EXPECT_NEAR(mean, weight, 0.05 * weight) << "it swings about its weight";
}

TEST_F(BodiesOfTheHistory, AParticleThatLeavesTakesItsMomentumAlong)
{
  const HistoryTable table = run(block_scene("time: {end: 0.6}\non_exit: delete\n" + with_bodies, ", velocity: [2, 0]"), "leaves");
  EXPECT_LT(last(table, "mass_block"), 0.9 * first(table, "mass_block")) << "particles have to leave";
  EXPECT_LT(largest(*table["force_block_x"]), 1e-9 * first(table, "momentum_block_x"));
}

TEST_F(BodiesOfTheHistory, TheMotionThatARestTakesOutIsNoForce)
{
  const HistoryTable table = run(block_scene("stages:\n  - {type: geostatic, duration: 5, ramp: 0.1, damping: 0.7, residual: 0.05}\n"
                                             "  - {type: run, duration: 0.05}\n"
                                             "loads: [{type: gravity, acceleration: [0, -10]}]\nboundaries: [{type: fixed, on: y_min}]\n" +
                                             with_bodies),
                                 "stages");
  const Real weight = (*table["mass_block"])[0] * 10;
  EXPECT_NEAR(last(table, "force_block_y"), weight, 0.1 * weight);
}

TEST_F(BodiesOfTheHistory, AreTheSameOnAnyNumberOfThreadsAndAfterAStop)
{
  run(two_disks, "one", "--threads 1");
  run(two_disks, "two", "--threads 2");
  EXPECT_EQ(read("one/history.csv"), read("two/history.csv"));
  write("stopped.yaml", two_disks);
  ASSERT_EQ(talus("run stopped.yaml --quiet --out stopped --until 33").code, 4);
  ASSERT_EQ(talus("run --resume stopped --quiet").code, 0);
  EXPECT_EQ(read("one/history.csv"), read("stopped/history.csv"));
}

TEST_F(BodiesOfTheHistory, AreNamedAsInTheScene)
{
  const auto wrong = [&](const std::string& bodies) {
    write("wrong.yaml", block_scene("time: {end: 1}\noutputs: {history: {every: 0.1, bodies: [" + bodies + "]}}\n"));
    const Outcome outcome = talus("run wrong.yaml");
    EXPECT_EQ(outcome.code, 2);
    return outcome.err;
  };
  EXPECT_THAT(wrong("blok"), HasSubstr("outputs.history.bodies[0]"));
  EXPECT_THAT(wrong("blok"), HasSubstr("block"));
  EXPECT_THAT(wrong("block, block"), HasSubstr("asked for twice"));
}

}  // namespace
}  // namespace talus::body_forces_test
