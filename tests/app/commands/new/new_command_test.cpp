// talus new: every template makes a scene that can be run, and what is wrong is told before anything is written.
#include <gmock/gmock.h>

#include "app/commands/new/templates.hpp"
#include "tests/app/program.hpp"

namespace talus::new_test {

namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class New : public Program {
 protected:
  /// Whether the scene passes the check, and runs to its end coarse and short.
  void expect_sound(const std::string& name) const
  {
    const Outcome check = talus("check " + name + ".yaml");
    EXPECT_EQ(check.code, 0) << name << check.err;
    const Outcome run = talus("run " + name + ".yaml --quick --quiet --out run_" + name);
    EXPECT_EQ(run.code, 0) << name << run.err;
  }
};

TEST_F(New, EveryTemplateWithItsDefaultsMakesASceneThatRuns)
{
  for (const std::string& name : template_names()) {
    const Outcome outcome = talus("new " + name);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    for (const char* next : {"talus check ", "talus run ", "talus render "})
      EXPECT_THAT(outcome.out, HasSubstr(next));
    expect_sound(name);
  }
}

TEST_F(New, EveryTemplateInThreeDimensionsMakesASceneThatRuns)
{
  for (const std::string& name : template_names()) {
    const std::string coarse = name == "slope" ? "size=3" : name == "impact" ? "cells=2" : "cells=5";
    const Outcome outcome = talus("new " + name + " --set dimension=3 --set " + coarse);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(read(name + ".yaml"), HasSubstr("\ndimension: 3\n"));
    expect_sound(name);
  }
}

TEST_F(New, OtherAnswersStandInTheSceneAndInTheCommandThatMakesItAgain)
{
  const std::string answers = "--set height=20 --set law=mohr_coulomb --set friction_angle=25 --set size=4";
  ASSERT_EQ(talus("new slope " + answers + " --out steep.yaml").code, 0);
  const std::string scene = read("steep.yaml");
  for (const char* part : {"title: A slope 20 m high", "law: mohr_coulomb", "friction_angle: 25", "  size: 4 ", "#     --set height=20",
                           "#     --set residual_friction_angle=12.5", "cohesion: 8000"})
    EXPECT_THAT(scene, HasSubstr(part));
  EXPECT_THAT(scene, AllOf(Not(HasSubstr("match:")), Not(HasSubstr("#if")), Not(HasSubstr("{="))));
  EXPECT_EQ(talus("check steep.yaml").code, 0);
}

TEST_F(New, TheCommandInTheHeadMakesTheSameScene)
{
  ASSERT_EQ(talus("new column --set height=3 --out first.yaml").code, 0);
  const std::string scene = read("first.yaml");
  const std::size_t begin = scene.find("#   talus new"), end = scene.find("\n#\n", begin);
  ASSERT_NE(end, scene.npos);
  std::string command = scene.substr(begin, end - begin);
  for (std::size_t at = command.find(" \\\n#"); at != command.npos; at = command.find(" \\\n#"))
    command.replace(at, 4, "");
  ASSERT_EQ(talus(command.substr(std::string_view("#   talus ").size()) + " --out second.yaml").code, 0) << command;
  EXPECT_EQ(read("second.yaml"), scene);
}

TEST_F(New, ReplacesNoFileUnlessForced)
{
  write("bar.yaml", "mine");
  const Outcome outcome = talus("new bar");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("bar.yaml is there already"));
  EXPECT_EQ(read("bar.yaml"), "mine");
  EXPECT_EQ(talus("new bar --force").code, 0);
  EXPECT_THAT(read("bar.yaml"), HasSubstr("title: A bar of 25 m"));
}

TEST_F(New, TellsAllWrongAnswersAtOnceAndWritesNothing)
{
  const Outcome outcome = talus("new slope --set height=-3 --set law=mohr_columb --set angel=30 --set size");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--set angel=30: error: template slope asks for no \"angel\" — did you mean \"angle\"?"));
  EXPECT_THAT(outcome.err, HasSubstr("--set size: error: write it as name=value"));
  const Outcome values = talus("new slope --set height=-3 --set law=mohr_columb");
  EXPECT_EQ(values.code, 2);
  EXPECT_THAT(values.err, HasSubstr("--set height=-3: error: -3 is outside [1, 200] m"));
  EXPECT_THAT(values.err, HasSubstr("did you mean \"mohr_coulomb\"?"));
  EXPECT_THAT(talus("new slope --set thickness=3").err, HasSubstr("nothing asks for this"));
  EXPECT_THAT(talus("new slop").err, HasSubstr("did you mean \"slope\"?"));
  EXPECT_FALSE(exists("slope.yaml"));
}

TEST_F(New, AsksOnATerminalAndSaysWhyAnAnswerIsNone)
{
  // `script` runs a command on a terminal of its own: the second answer is wrong, then the input ends.
  write("answers.txt", "3\n-5\n12\n");
  const std::string command = "cd '" + folder_.path().string() +
                              "' && (cat answers.txt; sleep 1; printf '\\004') | script -qec '" TALUS_BINARY
                              " new bar' said.txt >/dev/null 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const std::string said = read("said.txt");
  EXPECT_THAT(said, HasSubstr("Length of the bar"));
  EXPECT_THAT(said, HasSubstr("-5 is outside [0.01, 1000] m"));
  EXPECT_THAT(said, HasSubstr("End of input: this and all further questions take their defaults."));
  EXPECT_THAT(read("bar.yaml"), AllOf(HasSubstr("\ndimension: 3\n"), HasSubstr("title: A bar of 12 m")));
}

TEST_F(New, ListsTemplatesAndTheirQuestions)
{
  const Outcome all = talus("new --list");
  EXPECT_EQ(all.code, 0);
  for (const std::string& name : template_names())
    EXPECT_THAT(all.out, HasSubstr(name + " "));
  EXPECT_THAT(talus("new slope --list").out, AllOf(HasSubstr("friction_angle"), HasSubstr("0 to 50 deg; default 20")));
  EXPECT_EQ(talus("new </dev/null").code, 2);
}

constexpr auto own_template = R"yaml(summary: A block
questions:
  - {name: size, ask: Size, unit: m, range: [1, 10], default: 2}
---
title: Block
dimension: 2
mesh: {grid: {low: [0, 0], high: [{= 2 * size}, {= 2 * size}], cells: [8, 8]}}
time: {end: 0.01}
materials: [{name: rubber, law: neo_hookean, density: 1000, youngs_modulus: 1.0e5, poisson_ratio: 0.3}]
bodies: [{name: block, material: rubber, shape: {type: box, low: [0, 0], high: [{size}, {size}]}}]
)yaml";

TEST_F(New, TakesATemplateOfOnesOwn)
{
  write("block.txt.yaml", own_template);
  ASSERT_EQ(talus("new ./block.txt.yaml --set size=4 --out scene.yaml").code, 0);
  EXPECT_THAT(read("scene.yaml"), HasSubstr("high: [8, 8], cells: [8, 8]"));
  EXPECT_EQ(talus("check scene.yaml").code, 0);
}

TEST_F(New, MistakesInATemplateAreLocated)
{
  const std::string good = own_template;
  const auto with = [&](const std::string& what, const std::string& instead) {
    std::string text = good;
    write("wrong.yaml", text.replace(text.find(what), what.size(), instead));
    const Outcome outcome = talus("new ./wrong.yaml --out scene.yaml");
    EXPECT_EQ(outcome.code, 2) << instead;
    EXPECT_FALSE(exists("scene.yaml")) << instead;
    return outcome.err;
  };
  EXPECT_THAT(with("{= 2 * size}", "{= 2 * seize}"), HasSubstr("./wrong.yaml:7:"));
  EXPECT_THAT(with("{size}, {size}", "{size}, {sise}"), AllOf(HasSubstr("./wrong.yaml:10:"), HasSubstr("did you mean \"size\"?")));
  EXPECT_THAT(with("default: 2", "default: 20"),
              AllOf(HasSubstr("./wrong.yaml:3:5: error: questions[0]"), HasSubstr("20 is outside [1, 10] m")));
  EXPECT_THAT(with("range: [1, 10]", "range: [1, 10], choices: [1]"), HasSubstr("give one of"));
  EXPECT_THAT(with("---\n", ""), HasSubstr("a line \"---\""));
  EXPECT_THAT(with("time: {end: 0.01}", "time: {end: -1}"), HasSubstr("scene.yaml:"));
}

}  // namespace

}  // namespace talus::new_test
