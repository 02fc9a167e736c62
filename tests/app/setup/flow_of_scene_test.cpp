// Flow of pore water in a scene: what set-up refuses, what it warns of, and what a run writes.
#include <gmock/gmock.h>

#include "tests/app/program.hpp"

namespace talus::flow_of_scene_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class FlowOfScene : public Program {
 protected:
  void write_scene(const std::string& pores, const std::string& flow, const std::string& table = "")
  {
    write("layer.yaml",
          "title: Layer\ndimension: 2\nmesh: {grid: {low: [0, 0], high: [1, 1], cells: [4, 4]}}\ntime: {end: 0.01}\n"
          "materials: [{name: soil, law: linear_elastic, density: 2000, youngs_modulus: 1.0e7, poisson_ratio: 0}]\n"
          "bodies: [{name: layer, material: soil, shape: {type: box, low: [0, 0], high: [1, 1]}}]\n"
          "water: {" +
              table + "flow: {bodies: [{body: layer, porosity: 0.4, " + pores + "}], " + flow +
              "}}\nloads: [{type: gravity, acceleration: [0, -9.81]}, {type: traction, on: y_max, pressure: 1.0e4}]\n"
              "boundaries: [{type: fixed, on: y_min}, {type: roller, on: x_min}, {type: roller, on: x_max}]\n"
              "outputs: {history: {every: 0.001}, particles: {every: 0.01, fields: [pore_pressure]}}\n");
  }
  Outcome check(const std::string& pores, const std::string& flow, const std::string& table = "")
  {
    write_scene(pores, flow, table);
    return talus("check layer.yaml");
  }
};

TEST_F(FlowOfScene, NeedsGroupsOfTheMesh)
{
  const Outcome outcome =
      check("permeability: 1.0e-3", "drained: [y_mx], heads: [{on: left, level: 1}], inflow: [{on: rain, rate: 1.0e-6}]");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("the mesh has no facet group \"y_mx\" — did you mean \"y_max\"?"),
                                 HasSubstr("water.flow.heads[0].on: the mesh has no facet group \"left\""),
                                 HasSubstr("water.flow.inflow[0].on: the mesh has no facet group \"rain\""), HasSubstr("3 errors")));
}

TEST_F(FlowOfScene, WarnsOfWhatIsHardlyMeant)
{
  EXPECT_THAT(check("permeability: 1.0e-14", "drained: [y_max]").err,
              HasSubstr("if it is an intrinsic permeability in m^2, water has 1e-07 m/s"));
  EXPECT_THAT(check("permeability: 1.0e-3", "surface: impermeable").err, HasSubstr("the water can leave nowhere"));
  const std::string table = "table: {elevation: 0.5}, ", unsafe = "makes the soil too strong, which is unsafe";
  EXPECT_THAT(check("permeability: 1.0e-3", "drained: [y_max]", table).err, HasSubstr(unsafe));
  EXPECT_THAT(check("permeability: 1.0e-3, retention: {entry: 1.0e4, exponent: 2}", "drained: [y_max]", table).err, Not(HasSubstr(unsafe)));
  EXPECT_EQ(check("permeability: 1.0e-3", "drained: [y_max]").err, "");
}

TEST_F(FlowOfScene, TakesUpALoadAtOnceAndKeepsAccountOfItsWater)
{
  write_scene("permeability: 1.0e-3", "drained: [y_max]");
  ASSERT_EQ(talus("run layer.yaml --quiet --out out").code, 0);
  const HistoryTable table = history("out");
  EXPECT_GT(last(table, "water_drained"), 0);
  EXPECT_NEAR(last(table, "water_defect"), 0, 1e-8 * last(table, "water_drained"));
  EXPECT_GT(last(table, "seepage"), 0);
  EXPECT_GT(last(table, "pressure_iterations"), 0);
  EXPECT_LT(last(table, "pressure_residual"), 1e-9);
  // What the base carries: the load and the weight.
  EXPECT_NEAR(last(table, "reaction_y_min_y"), 1e4 + 2000 * 9.81, 0.15 * 3e4);
}

}  // namespace
}  // namespace talus::flow_of_scene_test
