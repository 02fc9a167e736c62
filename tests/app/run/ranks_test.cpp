// Several ranks write the same files as one, to the last bit: every law, kernel, transfer, boundary and stage.
#include <gmock/gmock.h>
#include <signal.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

#include "io/output/vtk.hpp"
#include "tests/app/program.hpp"
#include "tests/app/same_state.hpp"
#include "tests/app/scenes_of_all.hpp"

namespace talus::ranks_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class OnRanks : public Program {
 protected:
  Outcome talus_on(int ranks, const std::string& words) const { return talus(words, launcher_of(ranks)); }
  void run_on(int ranks, const std::string& words, int code = 0) const
  {
    const Outcome outcome = ranks == 1 ? talus(words) : talus_on(ranks, words);
    ASSERT_EQ(outcome.code, code) << words << "\n" << outcome.err;
  }
  /// All files but checkpoints, whose rows stand in another order, and the summary, which has times.
  void expect_same_files(const std::string& a, const std::string& b) const
  {
    for (const std::string folder : {"maps", "sections"})
      if (exists(a + "/" + folder))
        expect_same_files_in(folder_ / a / folder, folder_ / b / folder);
    std::set<std::string> names[2];
    for (const auto& [folder, seen] : {std::pair(a, &names[0]), std::pair(b, &names[1])})
      for (const auto& entry : fs::directory_iterator(folder_ / folder))
        if (entry.is_regular_file() && entry.path().filename() != "summary.json")
          seen->insert(entry.path().filename().string());
    EXPECT_EQ(names[0], names[1]);
    for (const std::string& name : names[0])
      EXPECT_TRUE(read(a + "/" + name) == read(b + "/" + name)) << name;
  }
};

int times_in(const std::string& text, const std::string& what)
{
  int n = 0;
  for (auto at = text.find(what); at != text.npos; at = text.find(what, at + 1))
    ++n;
  return n;
}

/// With as many cells as some blocks have.
std::string in_blocks(SceneParts parts)
{
  const auto replace = [](std::string& text, const std::string& from, const std::string& to) {
    if (const auto at = text.find(from); at != text.npos)
      text.replace(at, from.size(), to);
  };
  replace(parts.dimension, "cells: [6, 6]", "cells: [20, 20]");
  replace(parts.dimension, "cells: [4, 4, 2]", "cells: [6, 6, 3]");
  replace(parts.time, "end: 0.042", "end: 0.012");
  return parts.text();
}

class EverySceneOnRanks : public OnRanks, public testing::WithParamInterface<SceneCase> {};

TEST_P(EverySceneOnRanks, GivesTheSameBits)
{
  write("scene.yaml", in_blocks(GetParam().parts));
  run_on(1, "run scene.yaml --quiet --threads 2 --out alone");
  run_on(3, "run scene.yaml --quiet --threads 1 --rebalance 11 --out three");  // first with the shares of the start, then with others
  expect_same_files("alone", "three");
}

/// Laws know nothing of ranks, but for heat, which goes by nodes, and parameters that belong to places: one of the others is enough for every
/// day.
std::vector<SceneCase> scenes_of(bool every_day)
{
  std::vector<SceneCase> chosen;
  for (const SceneCase& scene : scenes_of_all())
    if ((!scene.name.starts_with("law_") || scene.name == "law_drucker_prager_softening" || scene.name == "law_johnson_cook_heat" ||
         scene.name == "law_mohr_coulomb_varied") == every_day)
      chosen.push_back(scene);
  return chosen;
}

INSTANTIATE_TEST_SUITE_P(Of, EverySceneOnRanks, testing::ValuesIn(scenes_of(true)), [](const auto& of) { return of.param.name; });
INSTANTIATE_TEST_SUITE_P(NightlyOf, EverySceneOnRanks, testing::ValuesIn(scenes_of(false)), [](const auto& of) { return of.param.name; });

/// Thrown from one end of the mesh to the other, over the borders of all parts.
SceneParts thrown()
{
  SceneParts parts;
  parts.dimension = "dimension: 2\nmesh: {grid: {low: [0, 0], high: [4, 1], cells: [48, 12]}}\n";
  parts.bodies =
      "bodies:\n"
      "  - {name: ball, material: stuff, shape: {type: sphere, centre: [0.4, 0.4], radius: 0.25}, particles_per_cell: 3, velocity: [40, "
      "2]}\n"
      "  - {name: gate, material: stuff, shape: {type: box, low: [3.5, 0], high: [3.8, 1]}, particles_per_cell: 3}\n";
  parts.boundaries = "boundaries: [{type: fixed, on: y_min}, {type: roller, on: x_max}, {type: roller, on: y_max}]\n";
  parts.time = "time: {end: 0.08}\n";
  parts.steps_of_a_checkpoint = 25;  // of 230
  return parts;
}

TEST_F(OnRanks, ABodyCrossesAllParts)
{
  write("scene.yaml", thrown().text());
  run_on(1, "run scene.yaml --quiet --threads 1 --out alone");
  EXPECT_GT(last(history("alone"), "toe"), 3.5) << "it should have come that far";
  for (const auto& [ranks, threads] : {std::pair(2, 2), std::pair(4, 1)}) {
    const std::string out = "ranks_" + std::to_string(ranks);
    run_on(ranks, "run scene.yaml --quiet --threads " + std::to_string(threads) + " --out " + out);
    expect_same_files("alone", out);
  }
}

TEST_F(OnRanks, MoreThanThereAreBlocks)
{
  write("scene.yaml", SceneParts{}.text());
  run_on(1, "run scene.yaml --quiet --out alone");
  for (const char* rebalance : {"", " --rebalance 3"}) {
    run_on(4, std::string("run scene.yaml --quiet --threads 1 --out four") + rebalance);
    expect_same_files("alone", "four");
  }
}

/// The number behind a key of the summary.
Real number_of(const std::string& key, const std::string& summary)
{
  const std::string quoted = '"' + key + "\": ";
  const auto at = summary.find(quoted);
  return at == summary.npos ? std::numeric_limits<Real>::quiet_NaN() : std::strtod(summary.c_str() + at + quoted.size(), nullptr);
}

TEST_F(OnRanks, SharesMoveAndNothingElseDoes)
{
  write("scene.yaml", thrown().text());
  run_on(1, "run scene.yaml --quiet --threads 1 --out alone");
  const Real steps = number_of("steps", read("alone/summary.json"));
  for (const int ranks : {2, 3}) {
    const std::string out = "ranks_" + std::to_string(ranks);
    const Outcome outcome = talus_on(ranks, "run scene.yaml --threads 1 --rebalance 5 --out " + out);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    expect_same_files("alone", out);
    const std::string summary = read(out + "/summary.json");
    EXPECT_EQ(number_of("rebalances", summary), std::floor((steps - 1) / 5)) << "before steps 6, 11, ...";
    EXPECT_GT(number_of("rebalancing [s]", summary), 0);
    EXPECT_LT(number_of("particles_of_the_busiest_over_mean", summary), 0.9 * ranks) << "the ball has gone from one end to the other";
    EXPECT_EQ(times_in(outcome.out, "shared out anew"), number_of("rebalances", summary)) << outcome.out;
  }
  run_on(2, "run scene.yaml --quiet --threads 1 --rebalance 0 --out never");
  EXPECT_EQ(number_of("rebalances", read("never/summary.json")), 0);
  expect_same_files("alone", "never");
}

constexpr int stopped = 4;

TEST_F(OnRanks, AnotherNumberOfThemGoesOnFromACheckpoint)
{
  write("scene.yaml", thrown().text());
  run_on(1, "run scene.yaml --quiet --out alone");
  run_on(3, "run scene.yaml --quiet --threads 1 --out again --until 40", stopped);
  run_on(2, "run --resume again --quiet --threads 1 --until 80", stopped);
  run_on(1, "run --resume again --quiet --threads 1 --until 120", stopped);
  run_on(4, "run --resume again --quiet --threads 1");
  expect_same_files("alone", "again");
}

TEST_F(OnRanks, CheckpointsDoNotKnowWhoseTheSharesWere)
{
  write("scene.yaml", thrown().text());
  run_on(1, "run scene.yaml --quiet --out alone");
  run_on(3, "run scene.yaml --quiet --threads 1 --out again --rebalance 10 --until 40", stopped);
  run_on(2, "run --resume again --quiet --threads 1 --rebalance 7 --until 83", stopped);
  run_on(4, "run --resume again --quiet --threads 1 --rebalance 9 --until 120", stopped);
  run_on(1, "run --resume again --quiet --threads 1 --rebalance 9");
  expect_same_files("alone", "again");
}

/// Each rank takes those in its cells of what another run has left, behind a body that it fills.
TEST_F(OnRanks, BodiesOfAnotherRunComeByParts)
{
  write("first.yaml", thrown().text());
  run_on(1, "run first.yaml --quiet --out first");
  SceneParts parts = thrown();
  parts.bodies =
      "bodies:\n"
      "  - {name: floor, material: stuff, shape: {type: box, low: [0, 0], high: [4, 0.2]}, particles_per_cell: 3}\n"
      "  - {name: ball, material: stuff}\n"
      "initial: {from: first}\n";
  parts.time = "time: {end: 0.01}\n";
  write("scene.yaml", parts.text());
  const Outcome alone = talus("run scene.yaml --quiet --out alone"),
                three = talus_on(3, "run scene.yaml --quiet --threads 1 --out three --rebalance 10");
  ASSERT_EQ(alone.code, 0) << alone.err;
  EXPECT_EQ(three.code, 0) << three.err;
  EXPECT_THAT(alone.err, HasSubstr("before its stage was over"));
  EXPECT_EQ(times_in(three.err, alone.err), 1) << alone.err << "\non three ranks:\n" << three.err;
  expect_same_files("alone", "three");
}

/// More particles, nodes and cells than a file has in a piece, so that all ranks write some of each, and read some when they go on.
TEST_F(OnRanks, LargeFilesAreWrittenByAllOfThem)
{
  SceneParts parts;
  parts.dimension = "dimension: 2\nmesh: {grid: {low: [0, 0], high: [2, 2], cells: [200, 200]}}\n";
  parts.bodies =
      "bodies:\n"
      "  - {name: low, material: stuff, shape: {type: box, low: [0, 0], high: [2, 0.4]}, particles_per_cell: 3, velocity: [0, -1]}\n"
      "  - {name: high, material: stuff, shape: {type: box, low: [0, 0.5], high: [2, 0.9]}, particles_per_cell: 3, velocity: [0, -2]}\n";
  parts.time = "time: {end: 1.0e-3}\n";
  parts.outputs = "";
  parts.steps_of_a_checkpoint = 1000000;
  write("scene.yaml", parts.text());
  run_on(1, "run scene.yaml --quiet --threads 2 --out alone");
  run_on(3, "run scene.yaml --quiet --threads 1 --out three --until 2", stopped);
  run_on(2, "run --resume three --quiet --threads 1");
  expect_same_files("alone", "three");
  const StoredParticles particles = read_particles(folder_ / "alone/particles_0001.vtp");
  EXPECT_GT(particles.ids.size(), 2U * rows_of_a_piece);
  EXPECT_TRUE(std::is_sorted(particles.ids.begin(), particles.ids.end()));
}

TEST_F(OnRanks, WhatIsWrongIsSaidOnce)
{
  write("wrong.yaml", SceneParts{.law = "law: neo_hookean, youngs_modulus: -1, poisson_ratio: 0.3"}.text());
  const Outcome scene = talus_on(3, "run wrong.yaml --quiet --out wrong");
  EXPECT_EQ(scene.code, 2);
  EXPECT_EQ(times_in(scene.err, "must be > 0 Pa"), 1) << scene.err;
  EXPECT_FALSE(exists("wrong"));

  SceneParts parts = thrown();
  parts.boundaries = "";
  parts.time = "time: {end: 10}\n";
  write("lost.yaml", parts.text());
  const Outcome alone = talus("run lost.yaml --quiet --out lost"),
                three = talus_on(3, "run lost.yaml --quiet --threads 1 --out lost_on_three");
  EXPECT_EQ(alone.code, 1);
  EXPECT_EQ(three.code, 1);
  const std::string what = alone.err.substr(0, alone.err.find("; last good output"));
  EXPECT_THAT(what, HasSubstr("is outside the mesh"));
  EXPECT_EQ(times_in(three.err, what), 1) << three.err;
}

/// Of all that set-up finds, which no rank has all the particles for.
TEST_F(OnRanks, SetUpComplainsAndWarnsAsOneRankDoes)
{
  const std::string head = R"yaml(title: Wrong
dimension: 2
mesh: {grid: {low: [0, 0], high: [1, 1], cells: [20, 20]}}
time: {end: 1.0e-4}
materials: [{name: rubber, law: neo_hookean, density: 1000, youngs_modulus: 1.0e5, poisson_ratio: 0}]
bodies:
  - {name: one, material: rubber, shape: {type: box, low: [0, 0], high: [1, 0.52]}}
  - {name: two, material: rubber, shape: {type: box, low: [0.2, 0.5], high: [0.8, 1]}}
)yaml";
  write("wrong.yaml", head + R"yaml(
  - {name: none, material: rubber, shape: {type: sphere, centre: [9, 9], radius: 1}}
  - {name: five, material: rubber, region: all, particles_per_cell: 5}
  - {name: root, material: rubber, shape: {type: box, low: [0, 0], high: [1, 1]}, velocity: ["sin(q)", "1 / (x - x)"]}
boundaries: [{type: roller, on: all}]
loads: [{type: traction, on: ceiling, pressure: 1}]
)yaml");
  write("warned.yaml", head + "loads: [{type: traction, on: y_max, pressure: 1}]\n");
  for (const auto& [scene, code] : {std::pair("wrong", 2), std::pair("warned", 0)}) {
    const std::string words = std::string("run ") + scene + ".yaml --quiet --threads 1 --out " + scene;
    const Outcome alone = talus(words), three = talus_on(3, words + "_on_three");
    EXPECT_EQ(alone.code, code) << alone.err;
    EXPECT_EQ(three.code, code) << three.err;
    EXPECT_FALSE(alone.err.empty());
    EXPECT_EQ(times_in(three.err, alone.err), 1) << alone.err << "\non three ranks:\n" << three.err;
  }
  expect_same_files("warned", "warned_on_three");
}

TEST_F(OnRanks, WhatTheyDoNotShareTheRootDoesAlone)
{
  write("scene.yaml", thrown().text());
  const Outcome alone = talus("check scene.yaml"), two = talus_on(2, "check scene.yaml");
  EXPECT_EQ(two.code, 0) << two.err;
  EXPECT_EQ(two.out, alone.out);

  write("wrong.yaml", SceneParts{.law = "law: neo_hookean, youngs_modulus: -1, poisson_ratio: 0.3"}.text());
  for (const char* words : {"check wrong.yaml", "check", "rum scene.yaml", "run"}) {
    const Outcome wrong = talus(words), on_two = talus_on(2, words);
    EXPECT_EQ(wrong.code, 2);
    EXPECT_EQ(on_two.code, 2) << on_two.err;
    EXPECT_EQ(times_in(on_two.err, wrong.err), 1) << words << ":\n" << on_two.err;
  }
  EXPECT_EQ(talus_on(2, "--version").out, talus("--version").out);
}

/// Processes whose command line holds `words`, the launcher left out.
std::vector<pid_t> ranks_running(const std::string& words)
{
  std::vector<pid_t> found;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != name.npos)
      continue;
    std::ifstream file(entry.path() / "cmdline");
    const std::string line((std::istreambuf_iterator<char>(file)), {});
    if (line.find(words) != line.npos && line.find("talus") < line.find('\0'))
      found.push_back(static_cast<pid_t>(std::stol(name)));
  }
  return found;
}

TEST_F(OnRanks, OneThatIsKilledEndsTheRunWhichCanGoOn)
{
  SceneParts parts = thrown();
  parts.time = "time: {end: 100}\n";
  parts.boundaries =
      "boundaries: [{type: fixed, on: y_min}, {type: fixed, on: x_max}, {type: fixed, on: y_max}, {type: fixed, on: x_min}]\n";
  write("scene.yaml", parts.text());
  const std::string out = (folder_ / "killed").string();
  std::thread run([&] { EXPECT_NE(talus_on(3, "run scene.yaml --quiet --threads 1 --out " + out).code, 0); });
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  const auto checkpoints = [&] { return exists("killed/checkpoints") ? files_in(folder_ / "killed/checkpoints", ".h5").size() : 0; };
  while (checkpoints() < 3 && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  const auto ranks = ranks_running(out);
  ASSERT_EQ(ranks.size(), 3U);
  kill(ranks[1], SIGKILL);
  run.join();  // that it comes back is the test
  EXPECT_TRUE(ranks_running(out).empty());
  const Outcome on = talus_on(2, "run --resume killed --quiet --threads 1 --until 40");
  EXPECT_EQ(on.code, 4) << on.err;
  EXPECT_THAT(on.err, HasSubstr("stopped as asked"));
}

}  // namespace
}  // namespace talus::ranks_test
