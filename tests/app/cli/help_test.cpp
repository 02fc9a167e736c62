// What the program tells of itself and of a run to come: manual KEY, --dry-run, completion.
#include <gmock/gmock.h>

#include <sstream>

#include "core/display_text.hpp"
#include "tests/app/program.hpp"

namespace talus::help_test {

namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class ManualOf : public Program {};

TEST_F(ManualOf, AKeyTellsMeaningUnitRangeDefaultAndPlace)
{
  const Outcome outcome = talus("manual time.cfl watch.energy_gain");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("cfl\n  time step as a share"), HasSubstr("number; [0.0001, 2]"), HasSubstr("in time\n"),
                                 HasSubstr("number; > 0; default 0.9")));
}

TEST_F(ManualOf, AKeyOfSeveralLawsIsToldForEach)
{
  const Outcome all = talus("manual friction_angle");
  EXPECT_THAT(all.out, AllOf(HasSubstr("number [deg]; [0, 90); required"), HasSubstr("materials (law: mohr_coulomb)"),
                             HasSubstr("materials (law: drucker_prager)")));
  const Outcome one = talus("manual drucker_prager.friction_angle");
  EXPECT_THAT(one.out, AllOf(HasSubstr("drucker_prager"), Not(HasSubstr("law: mohr_coulomb"))));
  EXPECT_EQ(talus("manual 'materials[0].friction_angle'").out, all.out);
}

TEST_F(ManualOf, LawsTypesKernelsBlocksWordsAndHistoryVariablesAreFound)
{
  EXPECT_THAT(talus("manual drucker_prager").out,
              AllOf(HasSubstr("Drucker-Prager cone"), HasSubstr("dilation_angle"), HasSubstr("opened_volume")));
  EXPECT_THAT(talus("manual friction").out, HasSubstr("Keys of boundaries (type: friction)"));
  EXPECT_THAT(talus("manual umls").out, AllOf(HasSubstr("kernel: umls"), HasSubstr("Keys of umls")));
  EXPECT_THAT(talus("manual kernel").out, AllOf(HasSubstr("kernel: linear"), HasSubstr("kernel: projected"), HasSubstr("kernel: umls")));
  EXPECT_THAT(talus("manual outputs").out, AllOf(HasSubstr("Keys of outputs"), HasSubstr("outputs.history.fronts")));
  EXPECT_THAT(talus("manual geostatic").out, HasSubstr("Keys of stages (type: geostatic)"));
  EXPECT_THAT(talus("manual box").out, HasSubstr("corner with the smallest coordinates"));
  EXPECT_THAT(talus("manual gravity").out, HasSubstr("number per dimension"));
  EXPECT_THAT(talus("manual aflip").out, HasSubstr("scheme\n"));
  EXPECT_THAT(talus("manual plastic_strain").out, HasSubstr("history variable"));
  EXPECT_THAT(talus("manual materials").out, HasSubstr("Further: talus manual"));
}

TEST_F(ManualOf, AnUnknownWordGetsASuggestion)
{
  const Outcome outcome = talus("manual cohession");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err, "error: the manual knows no \"cohession\" — did you mean \"cohesion\"?\n");
  EXPECT_EQ(talus("manual time.cohesion").code, 2);
}

class DryRun : public Program {};

TEST_F(DryRun, TellsStepsDiskAndTimeAndWritesNothing)
{
  write("block.yaml", block_scene("time: {end: 0.5}\noutputs: {particles: {every: 0.1}, history: {every: 0.01}}\n"));
  const Outcome outcome = talus("run block.yaml --dry-run --threads 1 --set time.end=1");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("96 particles"), HasSubstr(" 12 particle files of "), HasSubstr("million particle-steps/s with 1 thread,"),
                    HasSubstr("  time: about "), HasSubstr("no errors, nothing was written")));
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path()))
    files += entry.path().extension() != ".txt" ? 1 : 0;
  EXPECT_EQ(files, 1u) << "the scene itself";
  EXPECT_EQ(talus("check block.yaml --set time.end=1").out.substr(0, 100), outcome.out.substr(0, 100));
}

TEST_F(DryRun, MeasuresEachStageAndHonoursQuick)
{
  write("block.yaml", block_scene("loads: [{type: gravity, acceleration: [0, -1]}]\nboundaries: [{type: fixed, on: y_min}]\n"
                                  "stages: [{type: geostatic, duration: 5}, {type: run, duration: 5}]\n"));
  const Outcome whole = talus("run block.yaml --dry-run"), quick = talus("run block.yaml --dry-run --quick");
  ASSERT_EQ(whole.code, 0) << whole.err;
  ASSERT_EQ(quick.code, 0) << quick.err;
  EXPECT_THAT(whole.out, AllOf(HasSubstr("; at most 5 s, "), HasSubstr("stage geostatic: about "), HasSubstr("stage run: about ")));
  const auto steps = [](const Outcome& outcome) {
    return std::stoi(outcome.out.substr(outcome.out.find("so about ") + std::string_view("so about ").size()));
  };
  EXPECT_LE(steps(quick), 210);
  EXPECT_GT(steps(whole), 2 * steps(quick));
}

TEST_F(DryRun, RefusesWhatARunWouldRefuse)
{
  write("block.yaml", block_scene("time: {end: -1}\n"));
  EXPECT_EQ(talus("run block.yaml --dry-run").code, 2);
  EXPECT_EQ(talus("run --resume runs/x --dry-run").code, 2);
}

TEST(Durations, AreWordsThatOneWouldSay)
{
  EXPECT_EQ(duration_in_words(0.034), "0.034 s");
  EXPECT_EQ(duration_in_words(9.4), "9.4 s");
  EXPECT_EQ(duration_in_words(59.4), "59 s");
  EXPECT_EQ(duration_in_words(59.6), "1 min 0 s");
  EXPECT_EQ(duration_in_words(3 * 3600 + 61), "3 h 1 min");
  EXPECT_EQ(duration_in_words(50 * 3600), "2 days 2 h");
}

class Completion : public Program {
 protected:
  /// What bash offers for the last of these words.
  std::string offered(const std::vector<std::string>& words) const
  {
    std::string script = "eval \"$('" TALUS_BINARY "' completion bash)\"\ncompopt() { :; }\nCOMP_WORDS=(talus";
    for (const std::string& word : words)
      script += " '" + word + "'";
    script += ")\nCOMP_CWORD=$(( ${#COMP_WORDS[@]} - 1 ))\n_talus\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n";
    write("complete.sh", script);
    const std::string command = "cd '" + folder_.path().string() + "' && bash complete.sh >offered.txt 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0);
    return read("offered.txt");
  }
};

/// Commands as --help lists them.
std::vector<std::string> commands_of(const std::string& help)
{
  std::vector<std::string> commands;
  std::istringstream lines(help.substr(help.find("Subcommands:\n")));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line))
    if (line.starts_with("  ") && line[2] != ' ')
      commands.push_back(line.substr(2, line.find(' ', 2) - 2));
  return commands;
}

TEST_F(Completion, KnowsEveryCommandInEveryShell)
{
  const auto commands = commands_of(talus("--help").out);
  ASSERT_GT(commands.size(), 10u);
  for (const char* shell : {"bash", "zsh", "fish"}) {
    const Outcome outcome = talus("completion " + std::string(shell));
    ASSERT_EQ(outcome.code, 0);
    for (const std::string& command : commands)
      EXPECT_THAT(outcome.out, HasSubstr(command)) << shell;
  }
  EXPECT_EQ(talus("completion tcsh").code, 2);
}

TEST_F(Completion, OffersCommandsOptionsWordsAndFiles)
{
  write("slope.yaml", "");
  write("slope.csv", "");
  std::filesystem::create_directory(folder_ / "slopes");
  EXPECT_EQ(offered({"che"}), "check\n");
  EXPECT_THAT(offered({"run", "--re"}), AllOf(HasSubstr("--resume\n"), HasSubstr("--rebalance\n"), Not(HasSubstr("--quick"))));
  EXPECT_EQ(offered({"verify", "--level", ""}), "quick\nfull\n");
  EXPECT_EQ(offered({"drive", "--test", "oe"}), "oedometer\n");
  EXPECT_EQ(offered({"run", "slo"}), "slope.yaml\nslopes\n");
  EXPECT_EQ(offered({"run", "--out", "slo"}), "slopes\n");
  EXPECT_THAT(offered({"new", "sl"}), HasSubstr("slope\n"));
  EXPECT_EQ(offered({"render", "--map", "c"}), "cividis\ncoolwarm\n");
  EXPECT_EQ(offered({"render", "--view", "t"}), "top\n");
}

}  // namespace

}  // namespace talus::help_test
