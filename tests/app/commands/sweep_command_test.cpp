// talus sweep: cases, each a run in a folder of its own, and their table.
#include <gmock/gmock.h>

#include <fmt/format.h>

#include <cmath>

#include "io/terrain/raster_file.hpp"
#include "tests/app/program.hpp"

namespace talus::sweep_test {

namespace {

using testing::HasSubstr;
using testing::Not;

class SweepProgram : public Program {
 protected:
  void SetUp() override { write("block.yaml", scene(0.02)); }
  static std::string scene(Real end)
  {
    return block_scene(
        "loads: [{type: gravity, acceleration: [0, -9.81]}]\nboundaries: [{type: fixed, on: y_min}]\n"
        "time: {max_step: 1.0e-3, end: " +
        std::to_string(end) + "}\noutputs: {history: {every: 0.01, fronts: [{name: toe, direction: +x}]}}\n");
  }
  void write_study(const std::string& vary, const std::string& rest = "") const
  {
    write("study.yaml", "scene: block.yaml\nvary:\n" + vary + rest);
  }
  Outcome sweep(const std::string& words = "") const { return talus("sweep study.yaml --out out --threads 1 " + words); }
  /// Lines of the table.
  std::vector<std::string> rows() const
  {
    std::istringstream text(read("out/sweep.csv"));
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);)
      lines.push_back(line);
    return lines;
  }
};

const std::string stiffness = "  materials[0].youngs_modulus: [1.0e5, 2.0e5]\n";

TEST_F(SweepProgram, RunsEachCaseAndKeepsATable)
{
  write_study(stiffness + "  bodies[0].velocity: [[0, 0], [0, -1]]\n", "collect: [toe, max(kinetic), steps]\n");
  const Outcome outcome = sweep("--jobs 2");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto table = rows();
  ASSERT_EQ(table.size(), 5U);
  EXPECT_EQ(table[0], "case,materials[0].youngs_modulus,bodies[0].velocity,status,toe [m],max(kinetic) [J],steps");
  EXPECT_THAT(table[1], testing::StartsWith("1,1.0e5,\"[0, 0]\",done,"));
  EXPECT_THAT(table[4], testing::StartsWith("4,2.0e5,\"[0, -1]\",done,"));
  EXPECT_THAT(outcome.out, HasSubstr("case 3: done after"));
  EXPECT_THAT(outcome.out, HasSubstr("max(kinetic) [J]"));
  const Outcome alone =
      talus("run block.yaml --quiet --threads 1 --out alone --set materials[0].youngs_modulus=2.0e5 --set 'bodies[0].velocity=[0, -1]'");
  ASSERT_EQ(alone.code, 0) << alone.err;
  EXPECT_EQ(read("alone/history.csv"), read("out/case_0004/history.csv"));
}

TEST_F(SweepProgram, RunsOnlyWhatIsNotDoneYet)
{
  write_study(stiffness);
  ASSERT_EQ(sweep("--case 2").code, 0);
  EXPECT_THAT(rows()[1], HasSubstr("1,1.0e5,to be run,"));
  EXPECT_THAT(rows()[2], HasSubstr("2,2.0e5,done,"));
  const Outcome rest = sweep();
  EXPECT_EQ(rest.code, 0) << rest.err;
  EXPECT_THAT(rest.out, testing::AllOf(HasSubstr("1 of 2 cases"), HasSubstr("case 1: begins"), Not(HasSubstr("case 2: begins"))));
  EXPECT_THAT(sweep().out, HasSubstr("0 of 2 cases"));
  write("block.yaml", scene(0.03));
  const Outcome changed = sweep("--list");
  EXPECT_EQ(changed.code, 0) << changed.err;
  EXPECT_THAT(changed.out, HasSubstr("case 1: its results are of another scene"));
  EXPECT_THAT(sweep().out, testing::AllOf(HasSubstr("2 of 2 cases"), HasSubstr("; its results are of another scene or of other changes)")));
  EXPECT_THAT(sweep("--quick").out, HasSubstr("2 of 2 cases")) << "what was run in full is no quick run";
}

TEST_F(SweepProgram, SaysAllErrorsOfAllCasesWhereTheirValuesStandAndRunsNothing)
{
  write_study("  materials[0].youngs_modulus: [1.0e5, -1]\n  bodies[0].material: [rubber, rubbr]\n  boundaries[0].on: [y_min, z_min]\n");
  const Outcome read_errors = sweep();
  EXPECT_EQ(read_errors.code, 2);
  EXPECT_THAT(read_errors.err, HasSubstr("study.yaml:3:40: error: materials[0] \"rubber\".youngs_modulus: -1 must be > 0 Pa"));
  EXPECT_THAT(read_errors.err, HasSubstr("study.yaml:4:32: error: bodies[0] \"block\".material: there is no material \"rubbr\""));
  EXPECT_THAT(read_errors.err, HasSubstr("2 errors, nothing was run."));
  write_study(
      "  boundaries[0].on: [y_min, z_min]\n  bodies[0].shape: [{type: box, low: [0, 0], high: [1, 1]}, {type: box, low: [0, 0], high: "
      "[0.01, 0.01]}]\n");
  const Outcome mesh_errors = sweep();
  EXPECT_EQ(mesh_errors.code, 2);
  EXPECT_THAT(mesh_errors.err, HasSubstr("study.yaml:3:29: error: boundaries[0].on: the mesh has no node, facet or cell group \"z_min\""));
  EXPECT_THAT(mesh_errors.err, HasSubstr("error: bodies[0] \"block\": the body has no particles"));
  EXPECT_THAT(mesh_errors.err, HasSubstr("2 errors, nothing was run."));
  EXPECT_FALSE(exists("out"));
}

TEST_F(SweepProgram, TellsFailedCasesAtTheEndAndRepeatsThem)
{
  write_study("  bodies[0].velocity: [[0, 0], [60, 0]]\n");  // the second leaves the mesh
  const Outcome outcome = sweep("--jobs 1");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("error: 1 of 2 cases failed"));
  EXPECT_THAT(outcome.err, HasSubstr("case 2 (bodies[0].velocity=[60, 0]): "));
  EXPECT_THAT(outcome.err, HasSubstr("is outside the mesh"));
  EXPECT_THAT(rows()[1], HasSubstr(",done,"));
  EXPECT_THAT(rows()[2], HasSubstr(",failed,"));
  const Outcome again = sweep();
  EXPECT_EQ(again.code, 1);
  EXPECT_THAT(again.out, testing::AllOf(HasSubstr("1 of 2 cases"), HasSubstr("case 2: begins")));
  EXPECT_THAT(sweep("--list").out, HasSubstr("is outside the mesh"));
}

TEST_F(SweepProgram, StopsWithCheckpointsAndGoesOn)
{
  write("block.yaml", scene(1000));
  write_study(stiffness);
  const auto sweep_until = [&](const std::string& condition, const std::string& words, const std::string& signal) {
    return talus("info >info.txt; '" TALUS_BINARY "' sweep study.yaml --out out " + words +
                 " >said.txt 2>told.txt & child=$!; for i in $(seq 2000); do " + condition +
                 " && break; sleep 0.05; done; sleep 0.2; kill -" + signal + " $child; wait $child");
  };
  EXPECT_EQ(sweep_until("[ -e out/case_0001/history.csv ] && [ -e out/case_0002/history.csv ]", "--jobs 2", "INT").code, 4);
  EXPECT_THAT(read("told.txt"), HasSubstr("stopped by SIGINT: of 2 cases 0 done, 2 stopped with a checkpoint"));
  EXPECT_THAT(sweep("--list").out, testing::ContainsRegex("1 +1.0e5 +stopped at t = "));
  EXPECT_EQ(sweep_until("grep -q 'case 1: goes on after t = ' said.txt", "--case 1", "TERM").code, 4) << read("told.txt");
}

TEST_F(SweepProgram, NamesNumbersThatNoCaseHas)
{
  write_study("  time.end: [0.005]\n", "collect: [toes, kinetic]\n");
  const Outcome outcome = sweep();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("study.yaml:4:11: collect[0]: no case has a number \"toes\" — did you mean \"toe\"?"));
}

TEST_F(SweepProgram, EachRunCanHaveALauncher)
{
  write_study("  time.end: [0.005]\n");
  EXPECT_EQ(talus("sweep study.yaml --out out --launcher 'nice -n 1'").code, 0);
  const Outcome missing = talus("sweep study.yaml --out other --launcher no_such_launcher");
  EXPECT_EQ(missing.code, 1);
  EXPECT_THAT(missing.err, HasSubstr("cannot be started: is there no no_such_launcher?"));
}

TEST_F(SweepProgram, WrongWordsEndWithTwo)
{
  write_study(stiffness);
  EXPECT_EQ(talus("sweep").code, 2);
  EXPECT_EQ(sweep("--case 0").code, 2);
  EXPECT_EQ(sweep("--jobs 0").code, 2);
  EXPECT_EQ(sweep("--case 1 --jobs 2").code, 2);
  EXPECT_EQ(talus("sweep other.yaml").code, 2);
  const Outcome beyond = sweep("--case 3");
  EXPECT_EQ(beyond.code, 2);
  EXPECT_THAT(beyond.err, HasSubstr("there is no case 3: study.yaml has 2"));
  EXPECT_FALSE(exists("out"));
}

TEST_F(SweepProgram, SamplesTellHowLikelyAndByWhichKey)
{
  write_study("  materials[0].youngs_modulus: {low: 1.0e5, high: 4.0e5}\n  time.end: {low: 0.01, high: 0.03}\n",
              "combine: latin\nsamples: 6\ncollect: [steps, simulated_time]\nexceed: [{map: height, above: 2.5}]\n");
  ASSERT_EQ(sweep("--jobs 2 --no-pictures").code, 0);
  const std::string correlation = read("out/correlation.csv");
  EXPECT_THAT(correlation, testing::StartsWith("number,materials[0].youngs_modulus,time.end,cases\n"));
  EXPECT_THAT(correlation, testing::ContainsRegex("simulated_time \\[s\\],[-0-9.]+,1,6\n"));
  std::istringstream curve(read("out/exceedance_simulated_time.csv"));
  std::vector<std::string> lines;
  for (std::string line; std::getline(curve, line);)
    lines.push_back(line);
  ASSERT_EQ(lines.size(), 7U);
  EXPECT_THAT(lines[0], testing::StartsWith("simulated_time [s],share_of_cases"));
  EXPECT_THAT(lines[1], testing::EndsWith(",1"));
  EXPECT_THAT(lines[4], testing::EndsWith(",0.5"));

  EXPECT_THAT(sweep("--list").err, HasSubstr("study.yaml:8:10: exceed[0]: case 1 has no maps/height.tif"));
  for (int number = 1; number <= 6; ++number)
    write_raster(folder_ / fmt::format("out/case_{:04}/maps/height.tif", number),
                 Raster{2, 1, 0, 0, 1, 1, {static_cast<Real>(number), number == 1 ? 9 : std::nan("")}, "", "m"});
  const Outcome list = sweep("--list");
  EXPECT_THAT(list.out, HasSubstr("share of 6 cases in which height exceeds 2.5")) << list.err;
  const Raster share = read_raster(folder_ / "out/exceedance_height.tif");
  EXPECT_NEAR(share.at(0, 0), 4.0 / 6, 1e-6);
  EXPECT_NEAR(share.at(1, 0), 1.0 / 6, 1e-6);
  write_raster(folder_ / "out/case_0002/maps/height.tif", Raster{2, 1, 0, 0, 2, 2, {1, 1}, "", "m"});
  EXPECT_THAT(sweep("--list").err, HasSubstr("the maps of case 1 and case 2 lie on different grids"));
}

TEST_F(SweepProgram, ATornadoPutsTheKeyFirstThatMattersMost)
{
  write_study("  bodies[0].particles_per_cell: {low: 3, mode: 3, high: 4}\n  time.end: {low: 0.01, high: 0.03}\n",
              "combine: tornado\ncollect: [simulated_time]\n");
  const Outcome outcome = sweep("--jobs 2 --no-pictures");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(read("out/tornado_simulated_time.csv"),
            "key,low value,high value,at low: simulated_time [s],at high: simulated_time [s],all in the middle: simulated_time [s]\n"
            "time.end,0.01,0.03,0.01,0.03,0.02\nbodies[0].particles_per_cell,3,4,0.02,0.02,0.02\n");
  EXPECT_EQ(rows().size(), 6U);
}

TEST_F(SweepProgram, GivesAllOptionsToThePackage)
{
  std::filesystem::create_directories(folder_ / "talus");
  write("talus/__init__.py", "");
  write("talus/__main__.py", "import sys\nprint('|'.join(sys.argv[1:]))\nsys.exit(7)\n");
  ::setenv("TALUS_PACKAGE", folder_.path().c_str(), 1);
  const Outcome all = talus("sweep 'a b.yaml' --out c --jobs 2 --threads 3 --launcher '--x -n 1' --list --quick --quiet --no-pictures");
  const Outcome one = talus("sweep a.yaml --case 4");
  ::unsetenv("TALUS_PACKAGE");
  EXPECT_EQ(all.code, 7) << all.err;
  EXPECT_THAT(all.out, testing::StartsWith("sweep|--program|/"));
  EXPECT_THAT(all.out,
              testing::EndsWith("talus|a b.yaml|--out=c|--jobs=2|--threads=3|--launcher=--x -n 1|--list|--no-pictures|--quick|--quiet\n"));
  EXPECT_THAT(one.out, testing::EndsWith("talus|a.yaml|--case=4\n"));
}

TEST_F(SweepProgram, TheExampleIsInOrder)
{
  const Outcome outcome = talus("sweep '" TALUS_SOURCE_DIR "/scenes/column_collapse/study.yaml' --quick --list --out out");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("materials[0].friction_angle"));
}

}  // namespace

}  // namespace talus::sweep_test
