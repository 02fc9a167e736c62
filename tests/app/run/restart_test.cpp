// A run that was stopped and goes on ends with the same bits as one that was not: every law, kernel, transfer, boundary and stage.
#include <gmock/gmock.h>

#include <limits>
#include <random>
#include <regex>

#include "tests/app/forged.hpp"
#include "tests/app/program.hpp"
#include "tests/app/same_state.hpp"
#include "tests/app/scenes_of_all.hpp"

namespace talus::restart_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Restart : public Program, public testing::WithParamInterface<SceneCase> {
 protected:
  void run(const std::string& words) const
  {
    const Outcome outcome = talus("run --quiet " + words);
    ASSERT_EQ(outcome.code, 0) << words << "\n" << outcome.err;
    const std::regex of_scene("warning: [^\n]*scene\\.yaml:[^\n]*\n");  // of coarse cells, say
    EXPECT_EQ(std::regex_replace(without_losses(outcome.err), of_scene, ""), "");
  }
  /// As if the run had been killed before it could write a later one.
  void forget_checkpoints_after(const fs::path& checkpoint) const
  {
    for (const auto& file : files_in(folder_ / "again/checkpoints", ".h5"))
      if (file.filename() > checkpoint.filename())
        fs::remove(file);
  }
};

/// Each link of the chain goes on from a checkpoint that the link before wrote, and goes on with its files.
TEST_P(Restart, GivesTheSameBitsThreeTimesInAChain)
{
  write("scene.yaml", GetParam().parts.text());
  run("scene.yaml --out whole --threads 2");
  const auto saved = files_in(folder_ / "whole/checkpoints", ".h5");
  ASSERT_GE(saved.size(), 4U) << "too few steps to stop at";
  fs::copy(folder_ / "whole", folder_ / "again", fs::copy_options::recursive);
  for (std::size_t link = 1; link <= 3; ++link) {
    forget_checkpoints_after(saved[link * (saved.size() - 1) / 4]);
    run("--resume again --threads 1");
    ASSERT_EQ(files_in(folder_ / "again/checkpoints", ".h5").size(), saved.size());
  }
  expect_same_results(folder_ / "whole", folder_ / "again");
}

INSTANTIATE_TEST_SUITE_P(Of, Restart, testing::ValuesIn(scenes_of_all()), [](const auto& of) { return of.param.name; });

using Checkpoint = Program;

/// A run that would take minutes.
std::string long_scene(const std::string& checkpoint = "")
{
  SceneParts parts;
  parts.time = "time: {end: 1000}\n";
  parts.boundaries =
      "boundaries: [{type: roller, on: y_min}, {type: roller, on: x_min}, {type: roller, on: x_max}, {type: roller, on: y_max}]\n";
  return parts.text() + checkpoint;
}

TEST_F(Checkpoint, IsWrittenWhenTheRunIsToldToStop)
{
  write("scene.yaml", long_scene());
  for (const std::string signal : {"TERM", "INT", "USR1"}) {
    const Outcome outcome = talus("info >info.txt; '" TALUS_BINARY "' run scene.yaml --quiet --out " + signal +
                                  " --threads 1 2>said.txt & child=$!; for i in $(seq 600); do [ -e " + signal +
                                  "/history.csv ] && break; sleep 0.05; done; sleep 0.2; kill -" + signal + " $child; wait $child");
    EXPECT_EQ(outcome.code, 4);
    const std::string said = read("said.txt");
    EXPECT_NE(said.find("stopped by SIG" + signal + " before step"), std::string::npos) << said;
    EXPECT_NE(said.find("go on with: talus run --resume " + signal), std::string::npos) << said;
    EXPECT_NE(read(signal + "/summary.json").find("\"status\": \"stopped\""), std::string::npos);
    EXPECT_FALSE(files_in(folder_ / signal / "checkpoints", ".h5").empty());
  }
}

TEST_F(Checkpoint, TheLastAreKeptAndADamagedOneGivesWayToTheOneBefore)
{
  SceneParts parts;
  std::string scene = parts.text();
  const std::string many = "checkpoint: {steps: 4, keep: 1000}";
  scene.replace(scene.find(many), many.size(), "checkpoint: {steps: 4, keep: 3}");
  write("scene.yaml", scene);
  ASSERT_EQ(talus("run scene.yaml --quiet --out out").code, 0);
  const auto saved = files_in(folder_ / "out/checkpoints", ".h5");
  ASSERT_EQ(saved.size(), 3u);
  fs::resize_file(saved.back(), fs::file_size(saved.back()) / 2);
  const Outcome outcome = talus("run --resume out --quiet");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("warning: "), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("going on from "), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find(saved[1].filename().string()), std::string::npos) << outcome.err;
  for (const auto& file : files_in(folder_ / "out/checkpoints", ".h5"))
    fs::resize_file(file, 100);
  const Outcome nothing_left = talus("run --resume out --quiet");
  EXPECT_EQ(nothing_left.code, 3);
  EXPECT_NE(nothing_left.err.find(saved[0].filename().string()), std::string::npos) << nothing_left.err;
}

TEST_F(Checkpoint, GoesOnInAFolderOfItsOwn)
{
  write("scene.yaml", SceneParts{}.text());
  ASSERT_EQ(talus("run scene.yaml --quiet --out whole").code, 0);
  const auto saved = files_in(folder_ / "whole/checkpoints", ".h5");
  const std::string middle = saved.at(saved.size() / 2).filename().string();
  ASSERT_EQ(talus("run --quiet --out rest --resume whole/checkpoints/" + middle).code, 0);
  expect_same_state(saved.back(), folder_ / "rest/checkpoints" / saved.back().filename());
  const HistoryTable whole = history("whole"), rest = history("rest");
  EXPECT_LT(rest.rows(), whole.rows());
  for (const char* column : {"time", "kinetic", "reaction_y_min_y", "top_x"})
    EXPECT_EQ(last(rest, column), last(whole, column)) << column;
  EXPECT_EQ(files_in(folder_ / "whole/checkpoints", ".h5"), saved) << "the run it came from was touched";
}

/// Killed without warning, at any moment: in a step, while a checkpoint or an output is written, while it reads one.
TEST_F(Checkpoint, KilledAnywhereARunGoesOnNightly)
{
  SceneParts parts;
  parts.time = "time: {end: 0.42, max_step: 1.4e-3}\n";
  write("scene.yaml", parts.text());
  ASSERT_EQ(talus("run scene.yaml --quiet --out whole --threads 1").code, 0);
  std::mt19937 random(7);
  std::uniform_real_distribution<Real> delay(0.05, 0.8);  // [s]; the run takes about one
  int kills = 0, runs = 0;
  while (kills < 200) {
    const bool can_go_on = exists("killed/checkpoints") && !files_in(folder_ / "killed/checkpoints", ".h5").empty();
    const std::string what = can_go_on ? "--resume killed" : "scene.yaml --out killed";
    const Outcome outcome = talus("info >info.txt; timeout --signal=KILL " + std::to_string(delay(random)) + " '" TALUS_BINARY "' run " +
                                  what + " --quiet --threads 1");
    if (outcome.code != 0) {
      ASSERT_EQ(outcome.code, 137) << outcome.err;
      ++kills;
      continue;
    }
    ++runs;
    expect_same_results(folder_ / "whole", folder_ / "killed");
    ASSERT_FALSE(HasFailure()) << "after " << kills << " kills";
    EXPECT_TRUE(files_in(folder_ / "killed", ".tmp").empty() && files_in(folder_ / "killed/checkpoints", ".tmp").empty());
    fs::remove_all(folder_ / "killed");
  }
  EXPECT_GT(runs, 0);
  RecordProperty("runs", runs);
  std::printf("%d kills, %d runs to the end\n", kills, runs);
}

TEST_F(Checkpoint, ThatNoRunCanHaveWrittenIsRefused)
{
  write("scene.yaml", SceneParts{}.text());
  ASSERT_EQ(talus("run scene.yaml --quiet --out out").code, 0);
  const auto saved = files_in(folder_ / "out/checkpoints", ".h5");
  const fs::path file = folder_ / "forged.h5";
  const auto refused_with = [&](const std::string& at, std::int64_t value) {
    fs::copy_file(saved[1], file, fs::copy_options::overwrite_existing);
    if (!at.empty())
      forge_value(file, at, 0, static_cast<double>(value));
    return talus("run --quiet --out forged --resume forged.h5");
  };
  EXPECT_EQ(refused_with("", 0).code, 0) << "a copy is as good";
  for (const auto& [at, value] : std::vector<std::pair<std::string, std::int64_t>>{{"stage/number", 1},
                                                                                   {"stage/number", -1},
                                                                                   {"bodies/count", 1},
                                                                                   {"bodies/0/end", 7},
                                                                                   {"walls/wall/count", 2},
                                                                                   {"particles/cell", 72},
                                                                                   {"particles/cell", -1},
                                                                                   {"particles/id", 100000},
                                                                                   {"recorder/history_state/followed", 100000},
                                                                                   {"recorder/history_state/followed", -1},
                                                                                   {"recorder/history_state/impulse/count", 0}}) {
    const Outcome outcome = refused_with(at, value);
    EXPECT_EQ(outcome.code, 3) << at << outcome.err;
    EXPECT_NE(outcome.err.find("do not fit the scene"), std::string::npos) << at << " " << outcome.err;
  }
  fs::copy_file(saved[1], file, fs::copy_options::overwrite_existing);
  forge_empty(file, "recorder/history_state/followed");
  const Outcome without_points = talus("run --quiet --out forged --resume forged.h5");
  EXPECT_EQ(without_points.code, 3) << without_points.err;
  EXPECT_THAT(without_points.err, HasSubstr("do not fit the scene"));
  for (const std::int64_t count : {std::int64_t{-1}, std::int64_t{1} << 60}) {
    const Outcome outcome = refused_with("recorder/files/count", count);
    EXPECT_EQ(outcome.code, 3) << outcome.err;
    EXPECT_NE(outcome.err.find("is not there"), std::string::npos) << outcome.err;
  }
  const auto refused_without = [&](const std::string& columns, int bodies) {
    fs::copy_file(saved[1], file, fs::copy_options::overwrite_existing);
    forge_empty(file, columns);
    forge_value(file, "bodies/count", 0, bodies);
    const Outcome outcome = talus("run --quiet --out forged --resume forged.h5");
    EXPECT_EQ(outcome.code, 3) << columns << outcome.err;
    EXPECT_THAT(outcome.err, testing::AllOf(HasSubstr("forged.h5: its "), HasSubstr(" do not fit the scene"))) << columns;
  };
  refused_without("all", 0);
  refused_without("all", 2);
  refused_without("particles/velocity", 2);
  refused_without("particles/start", 2);
}

/// Each with its place; what is wrong besides is said as well.
TEST_F(Checkpoint, OfAnUnsoundStateIsRefused)
{
  SceneParts parts;
  parts.law = metal_law;
  write("scene.yaml", parts.text());
  ASSERT_EQ(talus("run scene.yaml --quiet --out out").code, 0);
  const fs::path good = files_in(folder_ / "out/checkpoints", ".h5")[1], file = folder_ / "forged.h5";
  const auto said = [&] {
    const Outcome outcome = talus("run --quiet --out forged --resume forged.h5");
    EXPECT_EQ(outcome.code, 3) << outcome.err;
    return outcome.err;
  };
  constexpr Real nan = std::numeric_limits<Real>::quiet_NaN(), infinity = std::numeric_limits<Real>::infinity();
  struct Forged {
    std::string at;
    Real value;
    std::string said;
  };
  for (const Forged& one : {Forged{"clock/time", nan, "clock/time is nan s, not a time from 0 on"},
                            {"clock/time", -1, "clock/time is -1 s, not a time from 0 on"},
                            {"clock/time", infinity, "clock/time is inf s, not a time from 0 on"},
                            {"clock/step", -5, "clock/step is -5, not a number from 0 on"},
                            {"clock/dt", nan, "clock/dt is nan s"},
                            {"clock/lag", -1, "clock/lag is -1 s, not a time from 0 on"},
                            {"stage/begin", nan, "stage/begin is nan s"},
                            {"energy/largest_seen", infinity, "energy/largest_seen is inf J"},
                            {"stage/begin", 1, "the stage began at step 0, t = 1 s, and the state is of step "},
                            {"particles/id", 0, "there is more than one particle "},
                            {"particles/position", nan, "at (nan, "},
                            {"particles/position", nan, "position is not finite"},
                            {"particles/velocity", infinity, ": velocity is not finite"},
                            {"particles/velocity_gradient", nan, ": velocity_gradient is not finite"},
                            {"particles/stress", nan, ": stress is not finite"},
                            {"particles/deformation_gradient", nan, ": deformation_gradient is not finite"},
                            {"particles/deformation_gradient", -1, ": det F is -"},
                            {"particles/mass", -3, ": mass is -3 kg, not above 0"},
                            {"particles/mass", 0, ": mass is 0 kg, not above 0"},
                            {"particles/volume", -1, ": volume is -1 m^2, not above 0"},
                            {"particles/volume0", 0, ": volume0 is 0 m^2, not above 0"},
                            {"laws/history/0/temperature", nan, ": temperature is not finite"},
                            {"laws/history/1/elastic_left", infinity, ": elastic_left is not finite"}}) {
    fs::copy_file(good, file, fs::copy_options::overwrite_existing);
    Real value = one.value;
    if (one.at == "particles/id")
      value = static_cast<Real>(ArrayReader(file).read<std::int64_t>(one.at).at(1));  // the number of its neighbour
    forge_value(file, one.at, 0, value);
    const std::string words = said();
    EXPECT_THAT(words, testing::AllOf(HasSubstr("forged.h5: "), HasSubstr(one.said))) << one.at;
    if (one.at.starts_with("particles/") && one.at != "particles/id") {
      EXPECT_THAT(words, testing::ContainsRegex("forged.h5: particle [0-9]+ of \"(low|high)\" \\(.*scene.yaml:[0-9:]+\\) at \\("))
          << one.at;
    }
  }
  fs::copy_file(good, file, fs::copy_options::overwrite_existing);
  forge_value(file, "particles/mass", 3, -1);
  forge_value(file, "particles/volume", 5, 0);
  EXPECT_THAT(said(), testing::AllOf(HasSubstr(": mass is -1 kg"), HasSubstr("; particle "), HasSubstr(": volume is 0 m^2")))
      << "all at once";

  forge_value(files_in(folder_ / "out/checkpoints", ".h5").back(), "particles/mass", 3, -1);
  const Outcome before = talus("run --quiet --resume out");
  EXPECT_EQ(before.code, 0) << before.err;
  EXPECT_THAT(before.err, testing::AllOf(HasSubstr("mass is -1 kg, not above 0; going on from "), HasSubstr("warning: ")))
      << "the one before";
}

/// A list that is too short in the newest leaves the names of bodies and walls as they are for the one before.
TEST_F(Checkpoint, WhatIsWrongWithTheNewestDoesNotSpoilTheOneBefore)
{
  write("scene.yaml", SceneParts{}.text());
  ASSERT_EQ(talus("run scene.yaml --quiet --out whole").code, 0);
  for (const std::string list : {"bodies/count", "walls/wall/count"}) {
    fs::remove_all(folder_ / "again");
    fs::copy(folder_ / "whole", folder_ / "again", fs::copy_options::recursive);
    forge_value(files_in(folder_ / "again/checkpoints", ".h5").back(), list, 0, 0);
    const Outcome outcome = talus("run --resume again --quiet");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("going on from "));
    expect_same_results(folder_ / "whole", folder_ / "again");
  }
}

TEST_F(Checkpoint, WithoutAnyParticleLeftIsAsGoodAsAnyOther)
{
  write("scene.yaml", block_scene("on_exit: delete\ntime: {end: 0.2, max_step: 2.0e-3}\noutputs:\n  checkpoint: {steps: 10, keep: 1000}\n"
                                  "  history: {every: 0.01, points: [{name: top, at: [1, 1]}]}\n  particles: {every: 0.05}\n",
                                  ", velocity: [0, 20]"));
  ASSERT_EQ(talus("run scene.yaml --quiet --out whole").code, 0);
  ASSERT_EQ(last(history("whole"), "mass"), 0) << "something has stayed";
  fs::copy(folder_ / "whole", folder_ / "again", fs::copy_options::recursive);
  const auto saved = files_in(folder_ / "again/checkpoints", ".h5");
  ASSERT_GE(saved.size(), 3U);
  const fs::path from = saved[saved.size() - 2];
  ASSERT_EQ(ArrayReader(from).rows("particles/id"), 0U);
  fs::remove(saved.back());
  const Outcome outcome = talus("run --quiet --resume again");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(without_losses(outcome.err), "");
  expect_same_results(folder_ / "whole", folder_ / "again");
}

TEST_F(Checkpoint, OfAnotherProgramIsTakenWithAWord)
{
  write("scene.yaml", SceneParts{}.text());
  ASSERT_EQ(talus("run scene.yaml --quiet --out out").code, 0);
  const fs::path good = files_in(folder_ / "out/checkpoints", ".h5")[1], file = folder_ / "forged.h5";
  for (const std::string part : {"commit", "compiler", "build"}) {
    const std::string was = ArrayReader(good).text("run/" + part);
    fs::copy_file(good, file, fs::copy_options::overwrite_existing);
    forge_text(file, "run/" + part, "of a friend");
    const Outcome outcome = talus("run --quiet --out forged --resume forged.h5");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "warning: the checkpoint was made by " + part + " of a friend; this program is " + part + " " + was +
                               ": results may differ in the last digits\n");
    EXPECT_THAT(read("out/summary.json"), HasSubstr(was)) << "the same words";
  }
}

/// A run on the mesh of a file.
class CheckpointOnAFile : public Program {
 protected:
  void SetUp() override
  {
    SceneParts parts;
    parts.dimension = "dimension: 2\nmesh: {file: box.msh}\n";
    write("grid.yaml", SceneParts{}.text());
    ASSERT_EQ(talus("mesh grid.yaml --out box.msh").code, 0);
    write("scene.yaml", parts.text());
    ASSERT_EQ(talus("run scene.yaml --quiet --out out").code, 0);
  }
};

TEST_F(CheckpointOnAFile, WithOtherGroupsIsRefused)
{
  ASSERT_EQ(talus("run --resume out --quiet").code, 0) << "nothing has changed";
  std::string msh = read("box.msh");
  const std::string one = "\"x_min\"", other = "\"x_max\"";
  const auto at = msh.find(one), there = msh.find(other);
  ASSERT_NE(at, msh.npos);
  ASSERT_NE(there, msh.npos);
  msh.replace(at, one.size(), other).replace(there, other.size(), one);
  write("box.msh", msh);
  ASSERT_EQ(talus("check scene.yaml").code, 0) << "it is as good a mesh";
  const Outcome outcome = talus("run --resume out --quiet");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("is not the one that the checkpoint was made with"));
}

TEST_F(CheckpointOnAFile, OfAnotherMeshIsRefused)
{
  write("finer.yaml", SceneParts{.dimension = "dimension: 2\nmesh: {grid: {low: [0, 0], high: [2, 2], cells: [7, 7]}}\n"}.text());
  ASSERT_EQ(talus("mesh finer.yaml --out box.msh").code, 0);
  const Outcome outcome = talus("run --resume out --quiet");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_NE(outcome.err.find("is not the one that the checkpoint was made with"), std::string::npos) << outcome.err;
}

TEST_F(Checkpoint, NothingToGoOnFromIsSaid)
{
  EXPECT_NE(talus("run --resume nowhere").err.find("nowhere is not there"), std::string::npos);
  fs::create_directory(folder_ / "empty");
  const Outcome outcome = talus("run --resume empty");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_NE(outcome.err.find("empty has no checkpoints"), std::string::npos) << outcome.err;
  write("text.h5", "not a checkpoint");
  EXPECT_EQ(talus("run --resume text.h5").code, 3);
  EXPECT_EQ(talus("run").code, 2);
  EXPECT_EQ(talus("run scene.yaml --resume out").code, 2);
}

}  // namespace
}  // namespace talus::restart_test
