// Wall time by phase in the summary of a run.
#include "app/run/run_phases.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "tests/app/program.hpp"

namespace talus::run_phases_test {
namespace {

Real value_of(const std::vector<NamedValue>& all, const std::string& name)
{
  const auto found = std::ranges::find(all, name, &NamedValue::name);
  return found == all.end() ? std::numeric_limits<Real>::quiet_NaN() : found->value;
}

TEST(RunPhases, ObserversAreOutputCheckpointsAndMonitoring)
{
  RunPhases phases;
  phases.seeding = 1, phases.kernel = 2, phases.initial_stress = 4, phases.observers = 60;
  const auto all = wall_by_phase(phases, {.locate = 8, .scatter = 16}, 30, 20);
  EXPECT_EQ(value_of(all, "seeding"), 1);
  EXPECT_EQ(value_of(all, "kernel"), 2);
  EXPECT_EQ(value_of(all, "initial_stress"), 4);
  EXPECT_EQ(value_of(all, "locate"), 8);
  EXPECT_EQ(value_of(all, "scatter"), 16);
  EXPECT_EQ(value_of(all, "output"), 30);
  EXPECT_EQ(value_of(all, "checkpoints"), 20);
  EXPECT_EQ(value_of(all, "monitoring"), 10);
  EXPECT_TRUE(std::isnan(value_of(all, "rebalancing")));
  EXPECT_EQ(phases.total(), 67);
}

TEST(RunPhases, ALapThatAnExceptionEndsCounts)
{
  StopWatch watch;
  Real seconds = 0;
  try {
    const LapAtEnd lap(watch, seconds);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    throw std::runtime_error("a checkpoint that ends the run");
  } catch (const std::runtime_error&) {
  }
  EXPECT_GE(seconds, 0.005);
}

class Phases : public Program {
 protected:
  /// The cost of a run in its summary.
  nlohmann::json cost(const std::string& run) const { return nlohmann::json::parse(read(run + "/summary.json"))["cost"]; }
  static Real sum(const nlohmann::json& cost)
  {
    Real seconds = 0;
    for (const auto& phase : cost["wall_by_phase"])
      seconds += phase.get<Real>();
    return seconds;
  }
  /// A block of 24 000 particles under its weight, with a stress at the start, frames and checkpoints.
  static std::string layer(const std::string& more = "")
  {
    return R"yaml(title: Layer
dimension: 2
mesh: {grid: {low: [0, 0], high: [2, 1.25], cells: [100, 50]}}
time: {end: 0.004}
materials: [{name: soil, law: neo_hookean, density: 1800, youngs_modulus: 1.0e7, poisson_ratio: 0.3}]
bodies: [{name: soil, material: soil, shape: {type: box, low: [0, 0], high: [2, 1]}, particles_per_cell: 3}]
boundaries: [{type: fixed, on: y_min}, {type: roller, on: x_min}, {type: roller, on: x_max}]
loads: [{type: gravity, acceleration: [0, -9.81]}]
outputs: {particles: {every: 0.001}, checkpoint: {steps: 10, at_end: true}}
)yaml" + more;
  }
};

TEST_F(Phases, NameSetUpStepsOutputAndCheckpointsAndLeaveOutLittle)
{
  write("layer.yaml", layer());
  const Outcome outcome = talus("run layer.yaml --quiet --threads 1 --out out");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto all = cost("out");
  for (const char* name : {"mesh", "seeding", "kernel", "build", "first_files", "initial_stress", "locate", "scatter", "nodes", "gather",
                           "stress", "output", "checkpoints", "monitoring"}) {
    ASSERT_TRUE(all["wall_by_phase"].contains(name)) << name;
    EXPECT_GT(all["wall_by_phase"][name].get<Real>(), 0) << name;
  }
  const Real total = all["wall [s]"].get<Real>();
  EXPECT_LE(sum(all), total * (1 + 1e-9));
  EXPECT_GT(sum(all), 0.8 * total);  // measured: 0.97; checks between steps have no phase
}

/// The checkpoint by which a run is stopped counts, and the phases of a run that goes on are those of its own wall time.
TEST_F(Phases, OfARunThatGoesOnAreItsOwn)
{
  write("layer.yaml", layer());
  const Outcome stopped = talus("run layer.yaml --quiet --threads 1 --out out --until 15 --set outputs.checkpoint.steps=1000");
  ASSERT_EQ(stopped.code, 4) << stopped.err;
  EXPECT_GT(cost("out")["wall_by_phase"]["checkpoints"].get<Real>(), 0);
  const Outcome on = talus("run --resume out --quiet --threads 1");
  ASSERT_EQ(on.code, 0) << on.err;
  EXPECT_LE(sum(cost("out")), cost("out")["wall [s]"].get<Real>() * (1 + 1e-9));
}

}  // namespace
}  // namespace talus::run_phases_test
