// What the check says about cells beside layers, surfaces and shear bands.
#include <gmock/gmock.h>

#include <fmt/format.h>

#include "tests/app/program.hpp"

namespace talus::check_cells_test {

namespace {

using testing::HasSubstr;

class CheckCells : public Program {};

/// Squares of 0.25 m: a seam of so many between two blocks of another material.
std::string seam(double top, double first = 1)
{
  return fmt::format(R"(title: Seam
dimension: 2
mesh: {{grid: {{low: [0, 0], high: [4, 3], cells: [16, 12]}}}}
materials:
  - {{name: rock, law: linear_elastic, density: 1000, youngs_modulus: 1.0e6, poisson_ratio: 0.3}}
  - {{name: clay, law: linear_elastic, density: 1000, youngs_modulus: 1.0e5, poisson_ratio: 0.3}}
bodies:
  - {{name: below, material: rock, shape: {{type: box, low: [0, 0], high: [4, {1}]}}}}
  - {{name: seam, material: clay, shape: {{type: box, low: [0, {1}], high: [4, {0}]}}}}
  - {{name: above, material: rock, shape: {{type: box, low: [0, {0}], high: [4, 2.5]}}}}
boundaries: [{{type: fixed, on: y_min}}]
time: {{end: 1}}
)",
                     top, first);
}

TEST_F(CheckCells, WarnsOfASeamOfOneCellAndNotOfOneOfTwo)
{
  write("one.yaml", seam(1.25));
  write("two.yaml", seam(1.5));
  const Outcome one = talus("check one.yaml"), two = talus("check two.yaml");
  EXPECT_THAT(one.err,
              HasSubstr("one.yaml:6:5: material \"clay\" is less than two cells thick where it lies between others (32 of its 32 cells)"));
  EXPECT_THAT(two.err, testing::Not(HasSubstr("two cells thick")));
}

TEST_F(CheckCells, WarnsOfExtendedSurfacesInStagesThatSeekRest)
{
  const auto scene = [](const std::string& surfaces, const std::string& end) {
    std::string text = seam(1.5) + "projected: {surfaces: " + surfaces + "}\n";
    text.replace(text.find("time: {end: 1}"), 14, end);
    return text;
  };
  const std::string rest = "loads: [{type: gravity, acceleration: [0, -9.81]}]\nstages: [{type: geostatic, duration: 1}]";
  write("rests.yaml", scene("extended", rest));
  write("moves.yaml", scene("extended", "time: {end: 1}"));
  write("plain.yaml", scene("plain", rest));
  EXPECT_THAT(talus("check rests.yaml").err, HasSubstr("rests.yaml:13:10: stage \"geostatic\" seeks rest and may not find it"));
  EXPECT_THAT(talus("check moves.yaml").err, testing::Not(HasSubstr("creeps")));
  EXPECT_THAT(talus("check plain.yaml").err, testing::Not(HasSubstr("creeps")));
}

TEST_F(CheckCells, WarnsOfABoundaryBetweenMaterialsThatCutsCells)
{
  write("cut.yaml", seam(1.65, 1.1));
  EXPECT_THAT(talus("check cut.yaml").err,
              HasSubstr("the boundary between their materials cuts cells, and is too strong by one to two cells"));
}

/// A body in cells of 0.25 m, of that material.
std::string body_of(const std::string& material)
{
  return "title: Coarse cells\ndimension: 2\nmesh: {grid: {low: [0, 0], high: [4, 3], cells: [16, 12]}}\nmaterials:\n" + material +
         R"(bodies:
  - {name: slope, material: clay, shape: {type: box, low: [0, 0], high: [4, 2]}}
boundaries: [{type: fixed, on: y_min}]
time: {end: 1}
)";
}

TEST_F(CheckCells, WarnsOfCellsThatAreCoarserThanASofteningLength)
{
  const auto scene = [](double length) {
    return body_of(fmt::format(
        R"(  - {{name: clay, law: mohr_coulomb, density: 2000, youngs_modulus: 1.0e6, poisson_ratio: 0.3, friction_angle: 0, cohesion: 1.0e4, residual_cohesion: 1.0e3,
     softening_strain: 0.1, softening_length: {}}}
)",
        length));
  };
  write("coarse.yaml", scene(0.2));
  write("fine.yaml", scene(0.3));
  EXPECT_THAT(
      talus("check coarse.yaml").err,
      HasSubstr("coarse.yaml:8:5: body \"slope\" has cells of 0.285 m where bands of failure are 1.26 m wide by its softening_length: they "
                "need six cells or more to be as wide on any mesh; take cells of at most 0.209 m"));
  EXPECT_THAT(talus("check fine.yaml").err, testing::Not(HasSubstr("softening_length")));
}

TEST_F(CheckCells, WarnsOfARandomFieldThatVariesWithinCells)
{
  const auto scene = [](double length) {
    return body_of(fmt::format(R"(  - name: clay
    law: von_mises
    density: 2000
    youngs_modulus: 1.0e6
    poisson_ratio: 0.3
    yield_stress: 1.0e4
    variation:
      - {{parameter: yield_stress, coefficient_of_variation: 1, correlation_length: [{}]}}
)",
                               length));
  };
  write("uneven.yaml", scene(0.8));
  write("even.yaml", scene(2));
  // log(2) / 2 (1 - exp(-0.285 / 0.8)) = 0.104; of 0.05 at 0.125 m
  EXPECT_THAT(
      talus("check uneven.yaml").err,
      HasSubstr(
          "uneven.yaml:12:9: yield_stress varies within the cells of 0.285 m of body \"slope\": their mean is about 10 % above the "
          "geometric mean, which counts along a slip surface; if it is a strength, failure may be found too seldom (unsafe): take cells "
          "of at most 0.12 m where it fails"));
  EXPECT_THAT(talus("check even.yaml").err, testing::Not(HasSubstr("unsafe")));
}

}  // namespace

}  // namespace talus::check_cells_test
