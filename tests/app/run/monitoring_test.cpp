// What a run is watched for, what it leaves when it is stopped for it, and what it says of its balances in the end.
#include <gmock/gmock.h>

#include "tests/app/program.hpp"

namespace talus::watch_test {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

class Watch : public Program {
 protected:
  std::string summary(const std::string& run) const { return read(run + "/summary.json"); }
  /// A number of the summary, the first of that name.
  Real number(const std::string& run, const std::string& key) const
  {
    const std::string text = summary(run), begin = "\"" + key + "\": ";
    const auto at = text.find(begin);
    return at == std::string::npos ? std::numeric_limits<Real>::quiet_NaN() : std::stod(text.substr(at + begin.size()));
  }
};

/// The block falls onto a rough floor.
std::string falling(const std::string& more)
{
  return block_scene(
      "time: {end: 0.05}\nloads: [{type: gravity, acceleration: [0, -10]}]\nboundaries: [{type: friction, on: y_min, "
      "coefficient: 0.3}]\noutputs: {history: {every: 0.01}}\n" +
          more,
      ", velocity: [2, 0]");
}

TEST_F(Watch, TooFastAParticleStopsTheRunWithACheckpoint)
{
  write("block.yaml", falling("watch: {speed: 2.03}\n"));
  const Outcome outcome = talus("run block.yaml --out out");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, ContainsRegex("error: step [0-9]+, t = 0.0[0-9]+ s: particle [0-9]+ of \"block\" \\(block.yaml:[0-9:]+\\) at "
                                         "\\([0-9.]+, [0-9.]+\\) moves at 2.0[0-9]+ m/s, beyond watch.speed = 2.03 m/s; last checkpoint "
                                         "out/checkpoints/step_[0-9]+.h5"));
  EXPECT_THAT(summary("out"), HasSubstr("\"status\": \"failed\""));
  const Outcome again = talus("run --resume out --quiet");
  EXPECT_EQ(again.code, 1) << "the fault is still there";
  const Outcome freed = talus("run --resume out --set watch.on_speed=warn");
  EXPECT_EQ(freed.code, 0) << freed.err;
  EXPECT_THAT(freed.err, HasSubstr("beyond watch.speed"));
  EXPECT_THAT(summary("out"), HasSubstr("\"status\": \"done\""));
  ASSERT_EQ(talus("run block.yaml --out straight --set watch.on_speed=warn").code, 0);
  EXPECT_EQ(read("straight/history.csv"), read("out/history.csv")) << "the stop and the policy change no number";
}

TEST_F(Watch, AWarningIsGivenOnceAndKeptInTheSummary)
{
  write("block.yaml", falling("watch: {speed: 2.03, on_speed: warn}\n"));
  const Outcome outcome = talus("run block.yaml --out out --quiet");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err, ContainsRegex("^warning: step [0-9]+, t = 0.0[0-9]+ s: a particle moves at 2.0[0-9]+ m/s, beyond watch.speed = "
                                         "2.03 m/s\n$"));
  EXPECT_GT(number("out", "steps_beyond"), 1);
  EXPECT_THAT(summary("out"), ContainsRegex("\"warnings\": \\[[^]]*beyond watch.speed = 2.03 m/s, in [0-9]+ steps"));
}

TEST_F(Watch, LimitsThatNobodyGaveDoNotStopASoundRun)
{
  write("block.yaml", falling(""));
  const Outcome outcome = talus("run block.yaml --out out");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_GT(number("out", "fastest [m/s]"), 2);
  EXPECT_GT(number("out", "speed_limit [m/s]"), 100);
  EXPECT_EQ(number("out", "steps_beyond"), 0);
  EXPECT_LT(number("out", "energy_gain"), 0.01);
}

TEST_F(Watch, AllBalancesAreToldAndClose)
{
  write("block.yaml", falling(""));
  const Outcome outcome = talus("run block.yaml --out out");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, ContainsRegex("audit: mass closes to [0-9.e-]+; momentum closes to [0-9.]+e-1[0-9]; angular momentum closes to "
                                         "[0-9.e-]+ \\(transfer loses [0-9.e-]+\\); energy closes to [0-9.e-]+\n"));
  const std::string text = summary("out"), closes = "\"closes\": true";
  int closed = 0;
  for (auto at = text.find(closes); at != std::string::npos; at = text.find(closes, at + 1))
    ++closed;
  EXPECT_EQ(closed, 4) << text;
}

TEST_F(Watch, ARunCanBeStoppedWhereItIsWanted)
{
  write("block.yaml", falling(""));
  ASSERT_EQ(talus("run block.yaml --out whole --quiet").code, 0);
  const Outcome stopped = talus("run block.yaml --out out --until 7");
  EXPECT_EQ(stopped.code, 4);
  EXPECT_THAT(stopped.err, HasSubstr("stopped as asked before step 8"));
  EXPECT_TRUE(exists("out/checkpoints/step_000000007.h5"));
  const Outcome another = talus("run --resume out --set dimension=3 --set time.cfl=0.1");
  EXPECT_EQ(another.code, 2);
  EXPECT_THAT(another.err, HasSubstr("--set dimension=3: error: a run that goes on can change only what stands in time, watch"));
  EXPECT_THAT(another.err, Not(HasSubstr("cfl")));
  ASSERT_EQ(talus("run --resume out --quiet").code, 0);
  EXPECT_EQ(read("whole/history.csv"), read("out/history.csv"));
}

TEST_F(Watch, WhatLeavesTheMeshTakesItsMomentumAlong)
{
  write("block.yaml", block_scene("time: {end: 0.4}\non_exit: delete\n", ", velocity: [3, 0]"));
  const Outcome outcome = talus("run block.yaml --out out");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_GT(number("out", "particles_removed"), 10);
  EXPECT_THAT(outcome.out,
              ContainsRegex("left the mesh or failed\naudit: mass closes to [0-9.e-]+; momentum closes to (0|[0-9.]+e-[1-9][0-9]);"));
}

TEST_F(Watch, WhatLeavesTheMeshTakesItsEnergyAlong)
{
  write("block.yaml", block_scene("time: {end: 1}\non_exit: delete\noutputs: {history: {every: 0.05}}\n", ", velocity: [3, 0]"));
  const Outcome outcome = talus("run block.yaml --out out");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const HistoryTable table = history("out");
  const Real all = first(table, "kinetic");
  ASSERT_EQ(last(table, "mass"), 0) << "it has left as it came";
  EXPECT_NEAR(all, 0.5 * 1000 * 9, 1e-9 * all);
  EXPECT_EQ(first(table, "carried_away"), 0);
  EXPECT_NEAR(last(table, "carried_away"), all, 1e-6 * all);
  for (const char* nothing : {"kinetic", "strain", "transfer_loss", "energy_defect"})
    EXPECT_NEAR(last(table, nothing), 0, 1e-6 * all) << nothing;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const Real left = 1000 - (*table["mass"])[row];
    EXPECT_NEAR((*table["carried_away"])[row], 0.5 * left * 9, 1e-6 * all) << "at t = " << (*table["time"])[row];
  }
  EXPECT_NEAR(number("out", "carried_away [J]"), all, 1e-6 * all);
  EXPECT_THAT(outcome.out, ContainsRegex("\n  carried_away +4500\n"));
}

/// A column of soil collapses out of a mesh that is narrow: what has flowed has dissipated, wherever it is now.
TEST_F(Watch, WhatIsDeletedKeepsItsPlasticWorkInTheBalance)
{
  std::string scene = block_scene(
      "time: {end: 0.6}\non_exit: delete\nloads: [{type: gravity, acceleration: [0, -9.81]}]\n"
      "boundaries: [{type: friction, on: y_min, coefficient: 0.5}]\noutputs: {history: {every: 0.02}}\n");
  const std::string rubber = "law: neo_hookean, density: 1000, youngs_modulus: 1.0e5, poisson_ratio: 0.3";
  scene.replace(scene.find(rubber), rubber.size(),
                "law: drucker_prager, density: 2000, youngs_modulus: 1.0e6, poisson_ratio: 0.3, friction_angle: 20, cohesion: 0, match: "
                "plane_strain");
  const std::string low = "low: [0.5, 0], high: [1.5, 1]";
  scene.replace(scene.find(low), low.size(), "low: [0, 0], high: [2, 1.75]");
  write("soil.yaml", scene);
  const Outcome outcome = talus("run soil.yaml --out out");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const HistoryTable table = history("out");
  EXPECT_GT(number("out", "particles_removed"), 20);
  EXPECT_GT(last(table, "carried_away"), 0);
  EXPECT_GT(last(table, "plastic"), 0);
  const auto plastic = *table["plastic"];
  for (std::size_t row = 1; row < plastic.size(); ++row)
    EXPECT_GE(plastic[row], (1 - 1e-9) * plastic[row - 1]) << "at t = " << (*table["time"])[row];
}

TEST_F(Watch, TheLastStepIsLookedAtToo)
{
  write("block.yaml", block_scene("time: {end: 0.004}\n", ", velocity: [0.1, 0]"));
  ASSERT_EQ(talus("run block.yaml --out out --quiet").code, 0);
  ASSERT_LT(number("out", "steps"), 10);
  EXPECT_NEAR(number("out", "fastest [m/s]"), 0.1, 1e-3);
  const Outcome stopped = talus("run block.yaml --out out --quiet --set watch.speed=0.09");
  EXPECT_EQ(stopped.code, 1);
  EXPECT_THAT(stopped.err, HasSubstr("moves at 0.1 m/s, beyond watch.speed = 0.09 m/s; last checkpoint out/checkpoints/step_00000000"));
  const Outcome freed = talus("run --resume out --quiet --set watch.on_speed=warn");
  EXPECT_EQ(freed.code, 0) << freed.err;
  const Real resumed = number("out", "steps_beyond");
  ASSERT_EQ(talus("run block.yaml --out straight --quiet --set watch.speed=0.09 --set "
                  "watch.on_speed=warn")
                .code,
            0);
  EXPECT_EQ(resumed, number("straight", "steps_beyond")) << "what stopped the run is counted once";
  EXPECT_GE(resumed, 1);
}

TEST_F(Watch, AStageThatWantsMoreTimeCanHaveIt)
{
  write("block.yaml", block_scene("stages: [{type: geostatic, duration: 0.05, damping: 0.7, residual: 1.0e-2}]\nloads: [{type: gravity, "
                                  "acceleration: [0, -10]}]\nboundaries: [{type: fixed, on: y_min}]\n"));
  const Outcome outcome = talus("run block.yaml --out out --quiet");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, ContainsRegex("did not come to rest within 0.05 s: .*; last checkpoint out/checkpoints/step_[0-9]+.h5\n$"));
  const Outcome damped = talus("run --resume out --set stages[0].damping=0.9");
  EXPECT_EQ(damped.code, 2) << "the stage has begun with another";
  const Outcome rested = talus("run --resume out --set stages[0].duration=20");
  EXPECT_EQ(rested.code, 0) << rested.err;
  EXPECT_THAT(rested.out, ContainsRegex("; momentum closes to [0-9.]+e-1[0-9];")) << "with damping, and the motion taken out at rest";
}

TEST_F(Watch, TheStateBeforeAFailedStepCanBeHad)
{
  write("block.yaml", block_scene("time: {end: 0.05}\n", ", velocity: [100, 0]"));
  const Outcome outcome = talus("run block.yaml --out out --quiet");
  ASSERT_EQ(outcome.code, 1);
  const std::string hint = "; the state before it: talus ";
  const auto at = outcome.err.find(hint);
  ASSERT_NE(at, std::string::npos) << outcome.err;
  const std::string command = outcome.err.substr(at + hint.size());
  EXPECT_THAT(command, ContainsRegex("^run block.yaml --out out --until [0-9]+\n$"));
  EXPECT_EQ(talus(command.substr(0, command.size() - 1) + " --quiet").code, 4);
  const Outcome again = talus("run --resume out --quiet");
  EXPECT_EQ(again.code, 1);
  const std::string body = " of \"block\"";
  EXPECT_EQ(again.err.substr(0, again.err.find(body)), outcome.err.substr(0, outcome.err.find(body))) << "the next step fails as it did";
  EXPECT_THAT(again.err, Not(HasSubstr("--until"))) << "it went on from there";
}

}  // namespace
}  // namespace talus::watch_test
