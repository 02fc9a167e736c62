// Wall time by phase in the summary of a run.
#include "app/run/run_phases.hpp"

#include <gmock/gmock.h>

#include <map>
#include <regex>
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
  struct Cost {
    Real wall = 0;
    std::map<std::string, Real> phases;
    Real sum() const
    {
      Real seconds = 0;
      for (const auto& [name, of_phase] : phases)
        seconds += of_phase;
      return seconds;
    }
  };
  /// The cost of a run in its summary.
  Cost cost(const std::string& run) const
  {
    const std::string text = read(run + "/summary.json");
    Cost cost;
    std::smatch found;
    if (std::regex_search(text, found, std::regex("\"wall \\[s\\]\": ([0-9.e+-]+)")))
      cost.wall = std::stod(found[1]);
    const auto begin = text.find("\"wall_by_phase\": {"), end = text.find('}', begin);
    const std::string phases = text.substr(begin + 17, end - begin - 17);
    const std::regex phase("\"([a-z_]+)\": ([0-9.e+-]+)");
    for (auto at = std::sregex_iterator(phases.begin(), phases.end(), phase); at != std::sregex_iterator(); ++at)
      cost.phases[(*at)[1]] = std::stod((*at)[2]);
    return cost;
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
  const Cost all = cost("out");
  for (const char* name : {"mesh", "seeding", "kernel", "build", "first_files", "initial_stress", "locate", "scatter", "nodes", "gather",
                           "stress", "output", "checkpoints", "monitoring"}) {
    ASSERT_TRUE(all.phases.contains(name)) << name;
    EXPECT_GT(all.phases.at(name), 0) << name;
  }
  EXPECT_LE(all.sum(), all.wall * (1 + 1e-9));
  EXPECT_GT(all.sum(), 0.8 * all.wall);  // measured: 0.97; checks between steps have no phase
}

/// The checkpoint by which a run is stopped counts, and the phases of a run that goes on are those of its own wall time.
TEST_F(Phases, OfARunThatGoesOnAreItsOwn)
{
  write("layer.yaml", layer());
  const Outcome stopped = talus("run layer.yaml --quiet --threads 1 --out out --until 15 --set outputs.checkpoint.steps=1000");
  ASSERT_EQ(stopped.code, 4) << stopped.err;
  EXPECT_GT(cost("out").phases["checkpoints"], 0);
  const Outcome on = talus("run --resume out --quiet --threads 1");
  ASSERT_EQ(on.code, 0) << on.err;
  EXPECT_LE(cost("out").sum(), cost("out").wall * (1 + 1e-9));
  EXPECT_GT(cost("out").wall, 0);
}

}  // namespace
}  // namespace talus::run_phases_test
