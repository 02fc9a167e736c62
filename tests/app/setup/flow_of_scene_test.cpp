// Flow of pore water in a scene: what set-up refuses, what it warns of, and what a run writes.
#include <gmock/gmock.h>

#include <numeric>

#include "io/output/vtk_layout.hpp"
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

/// The mean of the last rows of a column.
Real mean_of_last(const HistoryTable& table, std::string_view column, std::size_t rows)
{
  const auto values = table[column].value();
  return std::accumulate(values.end() - static_cast<std::ptrdiff_t>(rows), values.end(), 0.0) / static_cast<Real>(rows);
}

/// The values of a field in a file of particles, by component.
std::vector<Real> field_of(const std::filesystem::path& file, std::string_view name)
{
  const VtkLayout layout(file, "PolyData");
  const VtkArray* array = layout.find("PointData", name);
  return array != nullptr ? layout.numbers(*array) : std::vector<Real>();
}

/// Water that stands above a table at the start, with a suction that grows up to 2 kPa; then it seeps down.
TEST_F(FlowOfScene, BeginsWithSuctionAndWritesWhatTheWaterDoes)
{
  write_scene("permeability: 1.0e-3, retention: {entry: 2.0e3, exponent: 2}", "pace: [[0, 2]]",
              "table: {elevation: 0.5}, suction: 2.0e3, ");
  const std::string fields = "pore_pressure, excess_pore_pressure, saturation, seepage_velocity, stress, effective_stress";
  ASSERT_EQ(talus("run layer.yaml --out out --set 'outputs.particles.fields=[" + fields + "]'").code, 0);
  const auto start = folder_ / "out" / "particles_0000.vtp";
  const auto pressure = field_of(start, "pore_pressure"), saturation = field_of(start, "saturation"), stress = field_of(start, "stress"),
             effective = field_of(start, "effective_stress");
  ASSERT_FALSE(pressure.empty());
  EXPECT_NEAR(*std::ranges::min_element(pressure), -2e3, 1e-3);
  EXPECT_GT(*std::ranges::max_element(pressure), 3e3);
  for (std::size_t p = 0; p < pressure.size(); ++p) {
    const Real full = pressure[p] < 0 ? 1 / std::sqrt(1 + std::pow(pressure[p] / 2e3, 2)) : 1;
    EXPECT_NEAR(saturation[p], full, 1e-5);
    EXPECT_NEAR(effective[6 * p] - stress[6 * p], full * pressure[p], 1e-2);  // Bishop
  }
  for (const Real excess : field_of(start, "excess_pore_pressure"))
    EXPECT_EQ(excess, 0);
  for (const Real speed : field_of(start, "seepage_velocity"))
    EXPECT_EQ(speed, 0);
  const auto later = folder_ / "out" / "particles_0001.vtp";
  const auto excess = field_of(later, "excess_pore_pressure"), speed = field_of(later, "seepage_velocity");
  EXPECT_GT(*std::ranges::max_element(excess), 5e3);  // of the load on top
  EXPECT_GT(*std::ranges::max_element(speed), 1e-4);
}

/// Open water presses on the layer with its weight: its base carries both.
TEST_F(FlowOfScene, OpenWaterIsALoad)
{
  write_scene("permeability: 1.0e-3", "heads: [{on: y_max, level: 3}]", "table: {elevation: 1}, ");
  ASSERT_EQ(talus("run layer.yaml --out out --set time.end=0.3").code, 0);
  const HistoryTable table = history("out");
  EXPECT_NEAR(mean_of_last(table, "reaction_y_min_y", 100), 1e4 + 2000 * 9.81 + 2 * 9810, 0.05 * 5e4);
}

/// A layer that ends between the nodes of its mesh, under a pond of 3 m; `stages` and more follow.
std::string layer_under_a_pond(const std::string& pond, const std::string& rest)
{
  return "title: Layer\ndimension: 2\nmesh: {grid: {low: [0, 0], high: [0.75, 1.5], cells: [6, 12]}}\n"
         "materials: [{name: soil, law: linear_elastic, density: 2000, youngs_modulus: 1.0e8, poisson_ratio: 0.25}]\n"
         "bodies: [{name: layer, material: soil, shape: {type: box, low: [0, 0], high: [0.75, 1.04]}, particles_per_cell: 4}]\n"
         "water: {table: {depth: 0}, flow: {bodies: [{body: layer, porosity: 0.4, permeability: 1.0e-2}], pond: " +
         pond +
         "}}\nloads: [{type: gravity, acceleration: [0, -10]}]\n"
         "boundaries: [{type: fixed, on: y_min}, {type: roller, on: x_min}, {type: roller, on: x_max}]\n"
         "outputs: {history: {every: 0.001}, particles: {every: 0.5, fields: [pore_pressure, effective_stress]}}\n" +
         rest;
}

/// Root mean squares of what particles lack of the hydrostatic pressure and of the effective stress of the buoyant weight along y.
std::pair<Real, Real> apart_from_rest(const std::filesystem::path& frame, Real level)
{
  const VtkLayout layout(frame, "PolyData");
  const auto places = layout.numbers(*layout.find("Points", "Points"));
  const auto pressure = field_of(frame, "pore_pressure"), effective = field_of(frame, "effective_stress");
  Real water = 0, soil = 0;
  for (std::size_t p = 0; p < pressure.size(); ++p) {
    const Real y = places[3 * p + 1];
    water += std::pow(pressure[p] - 9810 * (level - y), 2);
    soil += std::pow(effective[6 * p + 1] + (2000 * 10 - 9810) * (1.04 - y), 2);
  }
  const auto n = static_cast<Real>(pressure.size());
  return {std::sqrt(water / n), std::sqrt(soil / n)};
}

TEST_F(FlowOfScene, SoilUnderAPondHasItsBuoyantWeight)
{
  const Real pond = 9810 * (4 - 1.04), soil = 1.04 * 2000 * 10;
  for (const std::string first :
       {"{type: geostatic, duration: 2, residual: 1.0e-4, initial_stress: {k0: 0.5}}", "{type: static, duration: 0.1, increments: 2}"}) {
    write("pond.yaml", layer_under_a_pond("{level: 4}", "stages: [" + first + ", {type: run, duration: 0.05}]\n"));
    const Outcome outcome = talus("run pond.yaml --out out");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, Not(HasSubstr("pond"))) << "the table at the ground is that of the pond";
    auto frame = folder_ / "out" / "particles_0000.vtp";
    for (int n = 1; std::filesystem::exists(folder_ / "out" / fmt::format("particles_{:04}.vtp", n)); ++n)
      frame = folder_ / "out" / fmt::format("particles_{:04}.vtp", n);
    const auto [water, effective] = apart_from_rest(frame, 4);
    EXPECT_LT(water, 0.002 * pond);
    EXPECT_LT(effective, 0.03 * soil);
    EXPECT_NEAR(mean_of_last(history("out"), "reaction_y_min_y", 20), 0.75 * (soil + pond), 0.01 * (soil + pond));
  }
}

/// A drawdown takes its weight from the layer, and the pressure below it.
TEST_F(FlowOfScene, APondSinks)
{
  write("pond.yaml", layer_under_a_pond("{level: 4, table: [[0.1, 1], [0.5, 0.5]]}", "time: {end: 1}\n"));
  ASSERT_EQ(talus("run pond.yaml --quiet --out out --set 'bodies[0].velocity=[0, 0]'").code, 0);
  EXPECT_NEAR(mean_of_last(history("out"), "reaction_y_min_y", 200), 0.75 * (1.04 * 2000 * 10 + 9810 * (2 - 1.04)), 600);
  EXPECT_LT(apart_from_rest(folder_ / "out" / "particles_0002.vtp", 2).first, 0.02 * 9810);
}

TEST_F(FlowOfScene, WarnsOfPondsThatCannotStand)
{
  write("pond.yaml", layer_under_a_pond("{level: 4}", "time: {end: 1}\n"));
  EXPECT_THAT(talus("check pond.yaml --set 'bodies[0].shape.high=[0.75, 1.5]'").err,
              HasSubstr("0.75 m of the ground below its level lie on the boundary of the mesh, where no pond stands"));
  write_scene("permeability: 1.0e-3", "drained: [y_max], pond: {level: 0.5}");
  EXPECT_THAT(talus("check layer.yaml").err, HasSubstr("without water.table the pore pressure below the pond begins at zero"));
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
  EXPECT_LT(last(table, "pressure_residual"), 1e-6);
  // What the base carries: the load and the weight.
  EXPECT_NEAR(last(table, "reaction_y_min_y"), 1e4 + 2000 * 9.81, 0.15 * 3e4);
}

/// A load on soil that hardly drains makes a pressure, with which another run goes on; held, it stays in every stage.
TEST_F(FlowOfScene, PressuresGoOnInAnotherRun)
{
  write_scene("permeability: 1.0e-6", "drained: [y_max]");
  ASSERT_EQ(talus("run layer.yaml --quiet --out out --set outputs.checkpoint.at_end=true").code, 0);
  const auto last_frame = [&](const std::string& run) {
    auto frame = folder_ / run / "particles_0000.vtp";
    for (int n = 1; std::filesystem::exists(folder_ / run / fmt::format("particles_{:04}.vtp", n)); ++n)
      frame = folder_ / run / fmt::format("particles_{:04}.vtp", n);
    return frame;
  };
  const auto sorted = [](std::vector<Real> values) {
    std::ranges::sort(values);
    return values;
  };
  const auto before = sorted(field_of(last_frame("out"), "pore_pressure"));
  ASSERT_FALSE(before.empty());
  ASSERT_GT(before.back(), 8e3);
  const std::string goes_on =
      " --quiet --set initial.from=out --set 'bodies=[{name: layer, material: soil}]' --set 'time={cfl: 0.4}' --set 'stages=[";
  ASSERT_EQ(talus("run layer.yaml --out held" + goes_on + "{type: run, duration: 0.01, hold_pore_pressure: true}]'").code, 0);
  EXPECT_THAT(sorted(field_of(last_frame("held"), "pore_pressure")), testing::ContainerEq(before));
  ASSERT_EQ(talus("run layer.yaml --out flows" + goes_on + "{type: run, duration: 1.0e-4}]'").code, 0);
  EXPECT_NEAR(sorted(field_of(last_frame("flows"), "pore_pressure")).back(), before.back(), 0.02 * before.back());
}

}  // namespace
}  // namespace talus::flow_of_scene_test
