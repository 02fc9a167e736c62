// talus new: every template is a scene that can be run, and what is wrong is told before anything is written.
#include <gmock/gmock.h>

#include "app/commands/new/new_command.hpp"
#include "tests/app/program.hpp"

namespace talus::new_test {

namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

class New : public Program {};

TEST_F(New, EveryTemplateIsASceneThatRuns)
{
  for (const std::string& name : template_names()) {
    const Outcome outcome = talus("new " + name);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    for (const char* next : {"talus check ", "talus run ", "talus render "})
      EXPECT_THAT(outcome.out, HasSubstr(next));
    const Outcome check = talus("check " + name + ".yaml");
    EXPECT_EQ(check.code, 0) << name << check.err;
    const Outcome run = talus("run " + name + ".yaml --quick --quiet --out run_" + name);
    EXPECT_EQ(run.code, 0) << name << run.err;
  }
}

TEST_F(New, ValuesTakeTheirPlacesAndCommentsStay)
{
  const Outcome outcome = talus(
      "new slope --out steep.yaml --set mesh.size=0.5 --set materials[0].cohesion=8.0e3 --set 'bodies[0].name=\"a hill\"' --set "
      "'loads[0].acceleration=[1, -9.81]' --set 'title=\"Steep: 1\"'");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string scene = read("steep.yaml");
  EXPECT_THAT(scene, ContainsRegex("\n  size: 0.5 +# m, edge length of the cells\n"));
  EXPECT_THAT(scene, ContainsRegex("\n    cohesion: 8.0e3 +# Pa; without drainage"));
  EXPECT_THAT(scene, HasSubstr("{name: \"a hill\", material: soil"));
  EXPECT_THAT(scene, HasSubstr("acceleration: [1, -9.81]}\n"));
  EXPECT_THAT(scene, HasSubstr("\ntitle: \"Steep: 1\"\n"));
  EXPECT_EQ(talus("check steep.yaml").code, 0);
}

TEST_F(New, CopiesASceneOfOnesOwn)
{
  write("block.yaml", block_scene("time: {end: 0.02}  # s\n"));
  ASSERT_EQ(talus("new ./block.yaml --set time.end=0.5 --out other.yaml").code, 0);
  EXPECT_EQ(read("other.yaml"), block_scene("time: {end: 0.5}  # s\n"));
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

TEST_F(New, WhatDoesNotFitIsToldAtOnceAndWritesNothing)
{
  const Outcome outcome = talus("new slope --set mesh.seize=3 --set stages=[] --set title");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("--set mesh.seize=3: error: slope has no mesh.seize: write it into the new file"),
                                 HasSubstr("--set stages=[]: error: stages stands on several lines: change it in the new file"),
                                 HasSubstr("--set title: error: write it as key=value")));
  const Outcome value = talus("new slope --set materials[0].cohesion=-3");
  EXPECT_EQ(value.code, 2);
  EXPECT_THAT(value.err, ContainsRegex("slope.yaml:[0-9]+:[0-9]+: error: materials\\[0\\] \"soil\".cohesion: -3 "));
  EXPECT_THAT(talus("new slop").err, HasSubstr("did you mean \"slope\"?"));
  EXPECT_THAT(talus("new").err, HasSubstr("say which template: bar, column, impact or slope"));
  EXPECT_FALSE(exists("slope.yaml"));
}

TEST_F(New, ListsTemplates)
{
  const Outcome all = talus("new --list");
  EXPECT_EQ(all.code, 0);
  for (const std::string& name : template_names())
    EXPECT_THAT(all.out, ContainsRegex(name + " +A[n]? [a-z]"));
  EXPECT_THAT(all.out, Not(HasSubstr("yaml-language-server")));
}

}  // namespace

}  // namespace talus::new_test
