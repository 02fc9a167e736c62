#include <gmock/gmock.h>

#include "tests/app/program.hpp"

namespace talus::check_test {

namespace {

using testing::HasSubstr;

class Check : public Program {};

TEST_F(Check, SaysWhatARunWouldCostAndWritesNothing)
{
  write("block.yaml", block_scene("time: {end: 0.1}\n"));
  const Outcome outcome = talus("check block.yaml");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("128 cells, 81 nodes, 96 particles"));
  EXPECT_THAT(outcome.out, HasSubstr("body \"block\": 96 particles"));
  EXPECT_THAT(outcome.out, HasSubstr("block.yaml: no errors"));
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path()))
    files += entry.path().extension() != ".txt" ? 1 : 0;
  EXPECT_EQ(files, 1u) << "the scene itself";
}

TEST_F(Check, NamesTheGroupThatWasMeant)
{
  write("block.yaml", block_scene("time: {end: 0.1}\nboundaries:\n  - {type: fixed, on: y_mim}\n"));
  const Outcome outcome = talus("check block.yaml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err,
            R"yaml(block.yaml:9:5: error: boundaries[0].on: the mesh has no node, facet or cell group "y_mim" — did you mean "y_min"?
    9 |   - {type: fixed, on: y_mim}
      |     ^
1 error, nothing was run.
)yaml");
}

TEST_F(Check, FindsEverythingThatTheMeshContradictsAtOnce)
{
  write("wrong.yaml", R"yaml(title: Wrong
dimension: 2
mesh: {grid: {low: [0, 0], high: [1, 1], cells: [2, 2]}}
time: {end: 1}
materials: [{name: rubber, law: neo_hookean, density: 1, youngs_modulus: 1, poisson_ratio: 0}]
bodies:
  - {name: one, material: rubber, region: sand}
  - {name: two, material: rubber, shape: {type: sphere, centre: [9, 9], radius: 1}}
  - {name: three, material: rubber, region: all, particles_per_cell: 5}
  - {name: four, material: rubber, shape: {type: box, low: [0, 0], high: [1, 0.5]}, velocity: ["sin(q)", "1 / (x - x)"]}
boundaries:
  - {type: roller, on: all}
loads:
  - {type: traction, on: y_max, pressure: 1}
  - {type: body_force, acceleration: ["sin(pi * x) * t", "2 * w"]}
)yaml");
  const Outcome outcome = talus("check wrong.yaml");
  EXPECT_EQ(outcome.code, 2);
  for (const char* line :
       {"wrong.yaml:7:5: error: bodies[0] \"one\".region: the mesh has no cell group \"sand\"; the mesh has all",
        "wrong.yaml:8:5: error: bodies[1] \"two\": the body has no particles: its shape contains no particle centre of the mesh",
        "wrong.yaml:9:5: error: bodies[2] \"three\".particles_per_cell: there is no symmetric set of 5 points in a triangle; there is 1, "
        "3, 4",
        "wrong.yaml:10:5: error: bodies[3] \"four\".velocity[0]: \"sin(q)\" is no formula of x, y, z and t: ",
        "wrong.yaml:10:5: error: bodies[3] \"four\".velocity[1]: \"1 / (x - x)\" is inf at (",
        "wrong.yaml:12:5: error: boundaries[0].on: the mesh has no facet group \"all\"",
        "wrong.yaml:14:5: error: loads[0].on: there are no particles behind the facets of \"y_max\" to carry the load",
        "wrong.yaml:15:5: error: loads[1].acceleration[1]: \"2 * w\" is no formula of x, y, z and t: ", "8 errors, nothing was run."})
    EXPECT_THAT(outcome.err, HasSubstr(line));
}

TEST_F(Check, RefusesAStressFromTheStartForALawThatHasNone)
{
  write("block.yaml", block_scene("stages: [{type: geostatic, duration: 1, initial_stress: {k0: 0.5}}]\n"));
  const Outcome outcome = talus("check block.yaml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("cannot start from a stress"));
}

TEST_F(Check, WarnsOfBodiesThatShareCells)
{
  write("two.yaml", block_scene("  - {name: other, material: rubber, shape: {type: box, low: [1.4, 0], high: [2, 1]}}\ntime: {end: 1}\n"));
  const Outcome outcome = talus("check two.yaml");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err,
              testing::MatchesRegex("warning: two\\.yaml:7:5: bodies \"block\" and \"other\" share [0-9]+ cells at the start\n"));
}

}  // namespace

}  // namespace talus::check_test
