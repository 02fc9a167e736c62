// Cuts of a scene: what is refused, and what a run writes.
#include <gmock/gmock.h>

#include "tests/app/program.hpp"

namespace talus::cuts_of_scene_test {
namespace {

using testing::HasSubstr;

/// A block in the whole mesh, which the group `joint` crosses halfway up; the groups `crossing` and `short_one` go upwards.
std::string block(const std::string& cuts, const std::string& more = "", const std::string& time = "time: {end: 0.02}",
                  const std::string& pull = "2", const std::string& load = "")
{
  return "title: Block\ndimension: 2\n"
         "mesh: {grid: {low: [0, 0], high: [2, 2], cells: [8, 8]}, groups: [\n"
         "  {name: joint, of: inside, within: {low: [-1, 0.99], high: [3, 1.01]}},\n"
         "  {name: crossing, of: inside, within: {low: [0.99, -1], high: [1.01, 3]}},\n"
         "  {name: short_one, of: inside, within: {low: [0.99, 1.2], high: [1.01, 1.6]}}]}\n" +
         time +
         "\n"
         "materials: [{name: stone, law: neo_hookean, density: 1000, youngs_modulus: 1.0e6, poisson_ratio: 0.3}]\n"
         "bodies: [{name: all, material: stone, shape: {type: box, low: [0, 0], high: [2, 1.5]}, particles_per_cell: 4}]\n"
         "loads: [{type: gravity, acceleration: [" +
         pull + ", -10]}" + (load.empty() ? "" : ", " + load) +
         "]\n"
         "outputs: {history: {every: 0.005}}\n" +
         more + "cuts:\n" + cuts;
}

class CutsOfScene : public Program {
 protected:
  Outcome check(const std::string& cuts, const std::string& more = "")
  {
    write("block.yaml", block(cuts, more));
    return talus("check block.yaml");
  }
};

TEST_F(CutsOfScene, WhatCannotBeIsRefusedWithItsPlace)
{
  const Outcome outcome = check(
      "  - {on: joint, friction: -1}\n  - {on: joint, cohesion: -2}\n  - {on: crossing, tied: true, friction: 3}\n"
      "  - {on: short_one, tied: true, tied_until: 3}\n  - {friction: 1}\n");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("block.yaml:13:27: error: cuts[0].friction: -1 must be >= 0\n"));
  EXPECT_THAT(outcome.err, HasSubstr("block.yaml:14:27: error: cuts[1].cohesion: -2 must be >= 0 Pa\n"));
  EXPECT_THAT(outcome.err, HasSubstr("block.yaml:14:10: error: cuts[1].on: cuts[0] is on \"joint\" already\n"));
  EXPECT_THAT(outcome.err, HasSubstr("block.yaml:15:5: error: cuts[2]: a cut that is always tied does not slide"));
  EXPECT_THAT(outcome.err, HasSubstr("block.yaml:16:5: error: cuts[3]: only one of tied (always) and tied_until may be given"));
  EXPECT_THAT(outcome.err, HasSubstr("block.yaml:17:5: error: cuts[4]"));
}

TEST_F(CutsOfScene, GroupsThatAreNoCutAreRefused)
{
  EXPECT_THAT(
      check("  - {on: jointt}\n").err,
      HasSubstr("block.yaml:13:5: error: cuts[0].on: the mesh has no facet group \"jointt\" \xE2\x80\x94 did you mean \"joint\"?\n"));
  EXPECT_THAT(check("  - {on: joint}\n  - {on: y_min}\n").err,
              HasSubstr("block.yaml:14:5: error: cuts[1].on: 8 of the 8 facets of \"y_min\" lie on the boundary of the mesh: a cut goes "
                        "through the inside, with cells on both of its sides\n"));
  EXPECT_THAT(check("  - {on: joint}\n  - {on: crossing}\n").err, HasSubstr("at (1, 1) cuts meet or cross and leave 4 sides"));
  const Outcome outcome = check("  - {on: short_one}\n");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("block.yaml:13:5: error: cuts[0].on: the cut \"short_one\" doubles no node"));
}

TEST_F(CutsOfScene, WhatIsNotSupportedIsRefusedByName)
{
  const Outcome outcome = check("  - {on: joint}\n", "projected: {surfaces: extended}\nboundaries: [{type: free_field, on: x_min}]\n");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("error: projected.surfaces: extended surfaces do not know the sides of cuts"));
  EXPECT_THAT(outcome.err, HasSubstr("error: boundaries[0]: absorbing boundaries and cuts"));
  write("two.yaml", block("  - {on: joint}\n", "contacts: [{between: [all, other]}]\n"));
  EXPECT_THAT(talus("check two.yaml").err, HasSubstr("error: cuts: cuts have one velocity field"));
}

TEST_F(CutsOfScene, ATractionOnACutIsRefused)
{
  write("block.yaml", block("  - {on: joint}\n", "", "time: {end: 0.02}", "0", "{type: traction, on: joint, traction: [0, 1]}"));
  EXPECT_THAT(talus("check block.yaml").err, HasSubstr("loads[1].traction: \"joint\" is a cut, and a traction would push both"));
}

TEST_F(CutsOfScene, APressureInACutPushesItsSidesApart)
{
  write("block.yaml", block("  - {on: joint}\n", "boundaries: [{type: fixed, on: y_min}]\n", "time: {end: 0.02}", "0",
                            "{type: traction, on: joint, pressure: 5.0e4}"));
  ASSERT_EQ(talus("run block.yaml --out results --quiet").code, 0);
  const HistoryTable table = history("results");
  EXPECT_GT(last(table, "load_work"), 100);
  EXPECT_EQ(last(table, "cut_joint_y"), 0);
}

TEST_F(CutsOfScene, CutsAreListedAndHaveColumns)
{
  const Outcome outcome = check("  - {on: joint, friction: 0.25, cohesion: 30, tied_until: 0.01}\n");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("cut \"joint\": tied until 0.01 s, then friction 0.25, cohesion 30 Pa\n"));
  EXPECT_EQ(talus("run block.yaml --out results --quiet").code, 0);
  EXPECT_THAT(read("results/history.csv"), HasSubstr("cut_joint_x [N],cut_joint_y [N],cut_friction_joint [J],cut_loss_joint [J]"));
}

TEST_F(CutsOfScene, ATiedCutChangesNothingWithLinearShapeFunctions)
{
  const std::string more = "kernel: linear\nboundaries: [{type: fixed, on: y_min}, {type: roller, on: x_min}]\n";
  write("tied.yaml", block("  - {on: joint, tied: true}\n", more));
  std::string uncut = block("", more);
  uncut.resize(uncut.rfind("cuts:"));
  write("uncut.yaml", uncut);
  ASSERT_EQ(talus("run tied.yaml --out tied --quiet").code, 0);
  ASSERT_EQ(talus("run uncut.yaml --out uncut --quiet").code, 0);
  const HistoryTable tied = history("tied"), plain = history("uncut");
  for (const std::string column : {"kinetic", "strain", "centre_x", "momentum_y", "reaction_y_min_y"})
    EXPECT_NEAR(last(tied, column), last(plain, column), 1e-10 * std::abs(last(plain, column))) << column;
  EXPECT_NE(last(tied, "cut_joint_y"), 0);
}

// A wall on the group of a cut acts on both sides: what rests on it from above does not press on what is below.
TEST_F(CutsOfScene, AWallOnACutActsOnBothSides)
{
  write("block.yaml",
        block("  - {on: joint}\n",
              "boundaries: [{type: friction, on: joint, coefficient: 0}, {type: friction, on: y_min, coefficient: 0}, "
              "{type: roller, on: x_min}, {type: roller, on: x_max}]\n",
              "stages: [{type: geostatic, duration: 5, ramp: 0.3, ramp_shape: smooth, damping: 0.7, residual: 5.0e-3}]", "0"));
  const Outcome outcome = talus("run block.yaml --out results --quiet");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const HistoryTable table = history("results");
  EXPECT_NEAR(last(table, "reaction_joint_y"), 10000, 300);  // of 1 m^2
  EXPECT_NEAR(last(table, "reaction_y_min_y"), 20000, 400);
  EXPECT_NEAR(last(table, "cut_joint_y"), 0, 1);
}

}  // namespace
}  // namespace talus::cuts_of_scene_test
