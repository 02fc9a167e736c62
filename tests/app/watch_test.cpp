// What a run is watched for, what it leaves when it is stopped for it, and what it says of its balances in the end.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/app/program.hpp"

namespace talus {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

class Watch : public Program {
 protected:
  nlohmann::json summary(const std::string& run) const { return nlohmann::json::parse(read(run + "/summary.json")); }
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
  write("block.yaml", falling("watch: {speed: 2.1}\n"));
  const Outcome outcome = talus("run block.yaml --out out");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, ContainsRegex("error: step [0-9]+, t = 0.0[0-9]+ s: particle [0-9]+ of \"block\" \\(block.yaml:[0-9]+\\) at "
                                         "\\([0-9.]+, [0-9.]+\\) moves at 2.1[0-9]+ m/s, beyond watch.speed = 2.1 m/s; last checkpoint "
                                         "out/checkpoints/step_[0-9]+.h5"));
  EXPECT_EQ(summary("out")["status"], "failed");
  const Outcome again = talus("run --resume out --quiet");
  EXPECT_EQ(again.code, 1) << "the fault is still there";
  const Outcome freed = talus("run --resume out --set watch.on_speed=warn");
  EXPECT_EQ(freed.code, 0) << freed.err;
  EXPECT_THAT(freed.err, HasSubstr("beyond watch.speed"));
  EXPECT_EQ(summary("out")["status"], "done");
  ASSERT_EQ(talus("run block.yaml --out straight --set watch.on_speed=warn").code, 0);
  EXPECT_EQ(read("straight/history.csv"), read("out/history.csv")) << "the stop and the policy change no number";
}

TEST_F(Watch, AWarningIsGivenOnceAndKeptInTheSummary)
{
  write("block.yaml", falling("watch: {speed: 2.1, on_speed: warn}\n"));
  const Outcome outcome = talus("run block.yaml --out out --quiet");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err, ContainsRegex("^warning: step [0-9]+, t = 0.0[0-9]+ s: a particle moves at 2.1[0-9]+ m/s, beyond watch.speed = "
                                         "2.1 m/s\n$"));
  EXPECT_GT(summary("out")["watch"]["steps_beyond"], 1);
  ASSERT_EQ(summary("out")["warnings"].size(), 1u);
  EXPECT_THAT(summary("out")["warnings"][0].get<std::string>(), HasSubstr("beyond watch.speed"));
}

TEST_F(Watch, LimitsThatNobodyGaveDoNotStopASoundRun)
{
  write("block.yaml", falling(""));
  const Outcome outcome = talus("run block.yaml --out out");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto watch = summary("out")["watch"];
  EXPECT_GT(watch["fastest [m/s]"], 2);
  EXPECT_GT(watch["speed_limit [m/s]"], 100);
  EXPECT_EQ(watch["steps_beyond"], 0);
  EXPECT_LT(watch["energy_gain"], 0.01);
}

TEST_F(Watch, AllBalancesAreToldAndClose)
{
  write("block.yaml", falling(""));
  const Outcome outcome = talus("run block.yaml --out out");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, ContainsRegex("audit: mass closes to [0-9.e-]+; momentum closes to [0-9.]+e-1[0-9]; angular momentum closes to "
                                         "[0-9.e-]+; energy closes to [0-9.e-]+\n"));
  for (const char* balance : {"mass", "momentum", "angular_momentum", "energy"})
    EXPECT_TRUE(summary("out")["balances"][balance]["closes"]) << balance;
}

TEST_F(Watch, TheStateBeforeAFailedStepCanBeHad)
{
  write("block.yaml", falling(""));
  ASSERT_EQ(talus("run block.yaml --out whole --quiet").code, 0);
  const Outcome stopped = talus("run block.yaml --out out --until 7");
  EXPECT_EQ(stopped.code, 4);
  EXPECT_THAT(stopped.err, HasSubstr("stopped as asked before step 8"));
  EXPECT_TRUE(exists("out/checkpoints/step_000000007.h5"));
  ASSERT_EQ(talus("run --resume out --quiet").code, 0);
  EXPECT_EQ(read("whole/history.csv"), read("out/history.csv"));
}

}  // namespace
}  // namespace talus
