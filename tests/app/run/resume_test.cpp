// What going on does with the files that are there: nothing of them is lost, and nothing of another way of the run is taken for its own.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "tests/app/program.hpp"
#include "tests/app/same_state.hpp"

namespace talus::resume_test {

namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Resume : public Program {
 protected:
  /// 0.2 s in steps of 2 ms at most, a checkpoint every 10, all kept.
  void SetUp() override
  {
    write("scene.yaml", scene());
    const Outcome outcome = talus("run scene.yaml --quiet --out out");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    ASSERT_GE(checkpoints("out").size(), 6u);
  }
  static std::string scene(const std::string& checkpoint = "{steps: 10, keep: 1000}")
  {
    return block_scene(
        "loads: [{type: gravity, acceleration: [0, -9.81]}]\nboundaries: [{type: fixed, on: y_min}]\n"
        "time: {end: 0.2, max_step: 2.0e-3}\n"
        "outputs: {particles: {every: 0.05}, mesh: {every: 0.1, fields: [velocity]}, history: {every: 0.01}, checkpoint: " +
        checkpoint + "}\n");
  }
  std::vector<fs::path> checkpoints(const std::string& run) const { return files_in(folder_ / run / "checkpoints", ".h5"); }
  static std::string name(const fs::path& file) { return file.filename().string(); }
};

TEST_F(Resume, FromAnOlderCheckpointSetsTheNewerAside)
{
  const auto all = checkpoints("out");
  const Outcome left = talus("run --resume out/checkpoints/" + name(all[2]) + " --set time.cfl=0.1 --until 33");
  ASSERT_EQ(left.code, 4) << left.err;
  EXPECT_THAT(left.err, HasSubstr("newer checkpoints than " + name(all[2])));
  EXPECT_THAT(left.err, HasSubstr(name(all[3]) + ".aside"));
  const auto now = checkpoints("out");
  ASSERT_EQ(now.size(), 4u);
  EXPECT_EQ(name(now.back()), "step_000000033.h5");
  EXPECT_EQ(files_in(folder_ / "out/checkpoints", ".aside").size(), all.size() - 3);
  const Outcome on = talus("run --resume out");
  ASSERT_EQ(on.code, 0) << on.err;
  EXPECT_THAT(on.out, HasSubstr("going on after step 33"));
  EXPECT_THAT(read("out/summary.json"), HasSubstr("time.cfl=0.1"));
}

TEST_F(Resume, KeepsTheCheckpointItHasJustWritten)
{
  const auto all = checkpoints("out");
  fs::resize_file(all.back(), 100);  // the newest is damaged
  const Outcome outcome = talus("run --resume out --quiet --set outputs.checkpoint.keep=1 --set outputs.checkpoint.at_end=true");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  ASSERT_EQ(checkpoints("out").size(), 1u);
  const Outcome over = talus("run --resume out");
  EXPECT_EQ(over.code, 0) << over.err;
  EXPECT_THAT(over.out, HasSubstr("nothing is left to do"));
}

TEST_F(Resume, ACopyOfACheckpointIsNotTakenForTheNewest)
{
  const auto all = checkpoints("out");
  fs::copy(all[1], folder_ / "out/checkpoints/step_000000020_backup.h5");
  const Outcome outcome = talus("run --resume out");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("going on after step " + std::to_string(std::stoi(name(all.back()).substr(5)))));
}

TEST_F(Resume, FromAFileOutsideARunAsksWhereTo)
{
  fs::create_directories(folder_ / "project/keep");
  const auto file = checkpoints("out")[3];
  fs::copy(file, folder_ / "project/keep/state.h5");
  write("project/scene.yaml", "mine\n");
  const Outcome refused = talus("run --resume project/keep/state.h5");
  EXPECT_EQ(refused.code, 3);
  EXPECT_THAT(refused.err, HasSubstr("project/keep/state.h5 lies in no folder of a run"));
  EXPECT_EQ(read("project/scene.yaml"), "mine\n");
  fs::create_symlink(file, folder_ / "latest.h5");
  EXPECT_EQ(talus("run --resume latest.h5 --quiet --until 45").code, 4) << "the run that the link leads to";
  EXPECT_EQ(name(checkpoints("out").back()), "step_000000045.h5");
  EXPECT_EQ(talus("run --resume project/keep/state.h5 --out elsewhere --quiet").code, 0);
}

TEST_F(Resume, WhatARunComesFromIsNotCleared)
{
  const auto before = checkpoints("out");
  fs::create_directories(folder_ / "out/checkpoints/keep");
  fs::copy(before[3], folder_ / "out/checkpoints/keep/state.h5");
  const Outcome refused = talus("run --resume out/checkpoints/keep/state.h5 --out out");
  EXPECT_EQ(refused.code, 3);
  EXPECT_THAT(refused.err, HasSubstr("is among the results in out, which this run replaces"));
  std::string again = scene();
  again.replace(again.find(", shape: {type: box, low: [0.5, 0], high: [1.5, 1]}, particles_per_cell: 3"),
                std::string(", shape: {type: box, low: [0.5, 0], high: [1.5, 1]}, particles_per_cell: 3").size(), "");
  write("again.yaml", again + "initial: {from: out/checkpoints/keep/state.h5}\n");
  const Outcome initial = talus("run again.yaml --out out");
  EXPECT_EQ(initial.code, 2) << initial.err;
  EXPECT_THAT(initial.err, HasSubstr("again.yaml:11:10: error: initial"));
  EXPECT_EQ(checkpoints("out"), before);
}

TEST_F(Resume, WhatIsMissingIsSaid)
{
  fs::remove(folder_ / "out/history.csv");
  fs::remove(folder_ / "out/mesh.pvd");
  fs::remove(folder_ / "out/particles_0001.vtp");
  const Outcome outcome = talus("run --resume out --quiet");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("out/history.csv lacks what was there up to t = "));
  EXPECT_THAT(outcome.err, HasSubstr("out/mesh.pvd is not there any more"));
  EXPECT_THAT(outcome.err, HasSubstr("out/particles_0001.vtp is not there any more"));
  EXPECT_THAT(read("out/summary.json"), HasSubstr("out/particles_0001.vtp is not there any more"));
}

TEST_F(Resume, InAFolderOfItsOwnNothingIsMissing)
{
  const auto all = checkpoints("out");
  const Outcome outcome = talus("run --resume out/checkpoints/" + name(all[3]) + " --out rest --quiet --until 55");
  EXPECT_EQ(outcome.code, 4);
  EXPECT_THAT(outcome.err, testing::Not(HasSubstr("warning"))) << outcome.err;
  const Outcome on = talus("run --resume rest --quiet");
  EXPECT_EQ(on.code, 0);
  EXPECT_EQ(on.err, "");
  EXPECT_THAT(read("rest/summary.json"), testing::Not(HasSubstr("particles_0000.vtp")));
  EXPECT_EQ(checkpoints("out"), all);
}

TEST_F(Resume, ChangesThatComeTooLateAreRefused)
{
  const Outcome back = talus("run --resume out --set time.end=0.05");
  EXPECT_EQ(back.code, 2);
  EXPECT_THAT(back.err, HasSubstr("--set time.end=0.05: error: the run is at t = "));
  ASSERT_EQ(talus("run --resume out --quiet --set outputs.checkpoint.at_end=true").code, 0);
  const Outcome over = talus("run --resume out --set time.end=0.4");
  EXPECT_EQ(over.code, 2);
  EXPECT_THAT(over.err, HasSubstr("--set time.end=0.4: error: this stage is over"));
}

TEST_F(Resume, TwoRunsDoNotWriteToOneFolder)
{
  std::string longer = scene();
  longer.replace(longer.find("end: 0.2"), 8, "end: 900");
  write("long.yaml", longer);
  const Outcome outcome = talus("info >info.txt; '" TALUS_BINARY
                                "' run long.yaml --quiet --out both >first.txt 2>&1 & child=$!; for i in $(seq 600); do "
                                "[ -e both/history.csv ] && break; sleep 0.05; done; '" TALUS_BINARY
                                "' run scene.yaml --quiet --out both >new.txt 2>&1; '" TALUS_BINARY
                                "' run --resume both --quiet >more.txt 2>&1; kill -TERM $child; wait $child");
  EXPECT_EQ(outcome.code, 4) << "the first goes on undisturbed until it is told to stop: " << read("first.txt");
  EXPECT_THAT(read("new.txt"), HasSubstr("another run is writing its results to both"));
  EXPECT_FALSE(checkpoints("both").empty());
}

/// Triangles around one node, more than kernel umls has room for.
std::string fan(int triangles)
{
  std::string nodes = "1 1 1 0\n", cells;
  for (int i = 0; i < triangles; ++i) {
    const Real angle = 2 * std::numbers::pi * i / triangles;
    nodes += fmt::format("{} {} {} 0\n", i + 2, 1 + 3 * std::cos(angle), 1 + 3 * std::sin(angle));
    cells += fmt::format("{} 2 2 1 1 1 {} {}\n", i + 1, i + 2, (i + 1) % triangles + 2);
  }
  return fmt::format("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n{}$EndNodes\n$Elements\n{}\n{}$EndElements\n", triangles + 1, nodes,
                     triangles, cells);
}

TEST_F(Resume, WhatAKernelRefusesCostsNoResults)
{
  write("fan.msh", fan(200));
  std::string refused = scene();
  const std::string grid = "{grid: {low: [0, 0], high: [2, 2], cells: [8, 8]}}", floor = "boundaries: [{type: fixed, on: y_min}]\n";
  refused.replace(refused.find(grid), grid.size(), "{file: fan.msh}").erase(refused.find(floor), floor.size());
  write("fan.yaml", refused + "kernel: umls\n");
  const Outcome outcome = talus("run fan.yaml --quiet --out out");
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("kernel umls: cell"));
  EXPECT_TRUE(exists("out/history.csv"));
  EXPECT_THAT(read("out/summary.json"), HasSubstr("\"status\": \"done\""));
}

TEST_F(Resume, ManySignalsAreOne)
{
  std::string longer = scene();
  longer.replace(longer.find("end: 0.2"), 8, "end: 900");
  write("long.yaml", longer);
  const Outcome outcome =
      talus("info >info.txt; '" TALUS_BINARY
            "' run long.yaml --quiet --out told 2>said.txt & child=$!; for i in $(seq 600); do "
            "[ -e told/history.csv ] && break; sleep 0.05; done; for i in $(seq 20); do kill -TERM $child; sleep 0.001; done; "
            "wait $child");
  EXPECT_EQ(outcome.code, 4) << read("said.txt");
  EXPECT_THAT(read("told/summary.json"), HasSubstr("\"status\": \"stopped\""));
  EXPECT_FALSE(exists("told/summary.json.tmp"));
}

}  // namespace
}  // namespace talus::resume_test
