// talus converge: levels of a scene, what is said of their numbers, and scenes that it refuses.
#include <gmock/gmock.h>

#include <sstream>

#include "app/commands/converge/converge_levels.hpp"
#include "tests/app/program.hpp"

namespace talus::converge_test {

namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// A bar of 25 m that swings in its first mode from rest length: after a quarter of its period of 10 s all of its energy is strain energy,
/// 1/2 * 1 kg/m^2 * (0.1 m/s)^2 * 25 m / 2 = 0.0625 J.
std::string bar_scene(const std::string& mesh = "grid: {low: [0, 0], high: [30, 1], cells: [30, 1]}", const std::string& more = "")
{
  return "title: Bar\ndimension: 2\nmesh: {" + mesh +
         "}\ntime: {end: 2.5, cfl: 0.4}\n"
         "materials: [{name: rubber, law: linear_first_piola, density: 1, youngs_modulus: 100, poisson_ratio: 0}]\n"
         "bodies: [{name: bar, material: rubber, shape: {type: box, low: [0, 0], high: [25, 1]}, particles_per_cell: 6, velocity: "
         "[\"0.1 * sin(pi * x / 50)\", \"0\"]}]\n"
         "boundaries: [{type: fixed, on: x_min}, {type: roller, on: y_min}, {type: roller, on: y_max}]\n"
         "outputs: {history: {every: 0.1, fronts: [{name: toe, direction: +x}]}}\n" +
         more;
}

class ConvergeProgram : public Program {
 protected:
  void SetUp() override { write("bar.yaml", bar_scene()); }
  Outcome converge(const std::string& words = "") const { return talus("converge bar.yaml --out out --threads 1 " + words); }
  /// The cells of a row of convergence.csv, whose headings are those of the first line.
  std::vector<std::string> row(const std::string& name) const
  {
    std::istringstream text(read("out/convergence.csv"));
    std::vector<std::string> cells;
    for (std::string line; std::getline(text, line);)
      if (line.starts_with(name + ",")) {
        std::istringstream words(line);
        for (std::string word; std::getline(words, word, ',');)
          cells.push_back(word);
      }
    return cells;
  }
};

TEST_F(ConvergeProgram, FindsTheEnergyOfABarAndItsOrder)
{
  const Outcome outcome = converge("--ratio 2 --finer 2 --jobs 2");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("cells_x0.25: begins (mesh.grid.cells=[120, 4])"), HasSubstr("cells_x1: done after"),
                                 HasSubstr("strain [J]")));
  std::istringstream lines(outcome.out.substr(outcome.out.find("cells of")));
  for (std::string line; std::getline(lines, line) && !line.starts_with("table");)
    EXPECT_LE(line.size(), 100U) << line;
  EXPECT_THAT(read("out/convergence.csv"), StartsWith("quantity,unit,cell_size_1 [m],cell_size_2 [m],cell_size_3 [m],value_1,value_2,"
                                                      "value_3,trend,order,extrapolated,uncertainty,verdict\n"));
  const auto strain = row("strain");
  ASSERT_EQ(strain.size(), 13U);
  EXPECT_EQ(strain[1], "J");
  EXPECT_NEAR(std::stod(strain[2]), 4 * std::stod(strain[4]), 1e-12);
  EXPECT_EQ(strain[8], "falls");
  EXPECT_EQ(strain[12], "converges");
  EXPECT_NEAR(std::stod(strain[9]), 2, 0.1) << "the order of the method";
  EXPECT_NEAR(std::stod(strain[7]), 0.0625, std::stod(strain[11])) << "the true value is within the uncertainty";
  EXPECT_NEAR(std::stod(strain[10]), 0.0625, 2e-6) << "the extrapolated value is nearer than the finest one, 1e-5";
  EXPECT_EQ(row("mass")[12], "constant");

  const Outcome again = converge("--ratio 2 --finer 2 --collect strain --within 1");
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_THAT(again.out, Not(HasSubstr("begins"))) << "what is done is kept";
  const Outcome strict = converge("--ratio 2 --finer 2 --collect 'strain,max(kinetic)' --within 1e-9 --quiet");
  EXPECT_EQ(strict.code, 1);
  EXPECT_THAT(strict.err, HasSubstr("error: not within 1e-07 %: strain: "));
  const Outcome json = converge("--ratio 2 --finer 2 --json");
  EXPECT_EQ(json.code, 0) << json.err;
  EXPECT_EQ(json.out, read("out/convergence.json"));
  EXPECT_THAT(json.out, HasSubstr("\"safety_factor\": 1.25"));
  const Outcome unknown = converge("--ratio 2 --finer 2 --collect straim,toe,nothing_like_it");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err,
              AllOf(HasSubstr("no level has a number \"straim\" — did you mean \"strain\"?"), HasSubstr("\"nothing_like_it\"")));
}

TEST_F(ConvergeProgram, WarnsWhereNumbersDoNotConverge)
{
  // Too few cells for a period: the velocity at the end of three very coarse bars.
  const Outcome outcome = converge("--ratio 2 --finer 2 --jobs 2 --set mesh.grid.cells=[3,1] --set time.end=7");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("do NOT CONVERGE at these sizes"), HasSubstr("--finer 3 goes on")));
}

TEST_F(ConvergeProgram, ListsLevelsAndWarnsOfGridsThatAreNotSimilar)
{
  const Outcome outcome = converge("--list");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("cells_x2 "), HasSubstr("cells_x1.414 "), HasSubstr("none: the scene as it is"),
                                 HasSubstr("mesh.grid.cells=[15, 1]"), HasSubstr("to be run")));
  EXPECT_THAT(outcome.err, HasSubstr("warning: bar.yaml:3:7: mesh.grid.cells: [15, 1] of a level is not similar to [30, 1] in the scene"));
  EXPECT_FALSE(exists("out"));
}

TEST_F(ConvergeProgram, RefusesCellsThatItCannotScale)
{
  write("bar.yaml", bar_scene("file: bar.msh", "initial: {from: runs/other}\n"));
  const Outcome outcome = converge();
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("bar.yaml:3:7: error: mesh.file: the cells of a mesh file stay as they are"), HasSubstr("talus sweep"),
                    HasSubstr("error: initial: the particles of another run keep their number"), HasSubstr("2 errors, nothing was run.")));
  EXPECT_FALSE(exists("out"));
}

TEST_F(ConvergeProgram, SaysErrorsOfCoarserLevelsInTheScene)
{
  write("bar.yaml", bar_scene("grid: {low: [0, 0], high: [30, 1], cells: [30, 8]}"));
  const Outcome outcome = converge("--ratio 4 --set 'bodies[0].shape={type: box, low: [0, 0], high: [1, 0.125]}'");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("the body has no particles"));
  EXPECT_THAT(outcome.err, HasSubstr("(with mesh.grid.cells="));
  EXPECT_FALSE(exists("out"));
}

TEST_F(ConvergeProgram, WrongWordsEndWithTwo)
{
  EXPECT_EQ(talus("converge").code, 2);
  EXPECT_EQ(talus("converge other.yaml").code, 2);
  EXPECT_EQ(converge("--levels 2").code, 2);
  EXPECT_EQ(converge("--ratio 1").code, 2);
  EXPECT_EQ(converge("--within 0.1").code, 2) << "of which numbers?";
  EXPECT_THAT(converge("--levels 3 --finer 3").err, HasSubstr("--finer 3 must be below --levels 3"));
  EXPECT_EQ(converge("--set time.end=-1").code, 2);
  EXPECT_FALSE(exists("out"));
}

TEST_F(ConvergeProgram, QuickRunsAreNotCompared)
{
  const Outcome outcome = converge("--quick --ratio 2 --finer 2");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("quick runs end after a number of steps"));
  EXPECT_FALSE(exists("out/convergence.csv"));
}

TEST(ScaledMesh, HasEveryKeyWithASize)
{
  MeshSpec grid;
  grid.grid = GridSpec{{0, 0}, {1, 1}, {10, 5}};
  EXPECT_THAT(scaled_mesh(grid, 0.5), ElementsAre("mesh.grid.cells=[20, 10]"));
  MeshSpec regions;
  regions.size = 0.3;
  regions.refine = {{{}, 0.1}, {{}, 0.02}};
  EXPECT_THAT(scaled_mesh(regions, 2), ElementsAre("mesh.size=0.6", "mesh.refine[0].size=0.2", "mesh.refine[1].size=0.04"));
  MeshSpec terrain;
  terrain.size = 12;
  terrain.terrain.emplace();
  terrain.terrain->layers.resize(2);
  terrain.terrain->layers[1].size = 6;
  terrain.terrain->air.emplace();
  terrain.terrain->air->size = 10;
  terrain.terrain->refine.resize(1);
  terrain.terrain->refine[0].size = 4;
  EXPECT_THAT(scaled_mesh(terrain, 0.5),
              ElementsAre("mesh.size=6", "mesh.terrain.layers[1].size=3", "mesh.terrain.air.size=5", "mesh.terrain.refine[0].size=2"));
}

}  // namespace

}  // namespace talus::converge_test
