// talus sweep: cases, each a run in a folder of its own, and their table.
#include <gmock/gmock.h>

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

TEST_F(SweepProgram, TheExampleIsInOrder)
{
  const Outcome outcome = talus("sweep '" TALUS_SOURCE_DIR "/scenes/column_collapse/study.yaml' --quick --list --out out");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("materials[0].friction_angle"));
}

}  // namespace

}  // namespace talus::sweep_test
