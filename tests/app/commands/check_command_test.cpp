#include <gmock/gmock.h>

#include <fmt/format.h>

#include <cmath>

#include "io/output/summary_json.hpp"
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

/// A stage that ends at rest is not counted at its full length, which is named.
TEST_F(Check, CountsTheStepsThatAStageAtRestUsuallyTakes)
{
  const std::string rest = R"yaml(loads: [{type: gravity, acceleration: [0, -9.81]}]
boundaries: [{type: roller, on: x_min}, {type: roller, on: x_max}, {type: roller, on: y_min}]
stages: [{type: geostatic, duration: 100}]
)yaml";
  write("block.yaml", block_scene(rest));
  const Outcome outcome = talus("check block.yaml");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto number_after = [&](const std::string& words) {
    const auto at = outcome.out.find(words);
    return at == std::string::npos ? -1 : std::stol(outcome.out.substr(at + words.size()));
  };
  const long least = number_after("so about "), most = number_after(fmt::format("so about {} to ", least)),
             bound = number_after("at most 100 s, ");
  EXPECT_GT(least, 0) << outcome.out;
  EXPECT_GT(most, least);
  EXPECT_GT(bound, 5 * most);
  const Outcome run = talus("run block.yaml --out out --quiet");
  ASSERT_EQ(run.code, 0) << run.err;
  const SummaryBack summary = read_summary(folder_ / "out/summary.json");
  const NamedValue* const steps = find_number(summary.numbers, "stages[0].steps");
  ASSERT_NE(steps, nullptr);
  EXPECT_GE(steps->value, 0.9 * static_cast<Real>(least));
  EXPECT_LE(steps->value, 1.1 * static_cast<Real>(most));
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

TEST_F(Check, NamesWhatIsWrongWithLoadsOnSidesOfBodies)
{
  write("wrong.yaml", R"yaml(title: Wrong
dimension: 2
mesh: {grid: {low: [0, 0], high: [1, 1], cells: [8, 8]}}
time: {end: 1}
materials: [{name: rubber, law: neo_hookean, density: 1, youngs_modulus: 1, poisson_ratio: 0}]
bodies:
  - {name: one, material: rubber, region: all}
  - {name: two, material: rubber, shape: {type: box, low: [0.1, 0.1], high: [0.9, 0.3]}}
loads:
  - {type: traction, on: "one:top", pressure: 1}
  - {type: traction, on: "two:top", pressure: 1}
  - {type: traction, on: "two:y_max", pressure: 1, carried_by: mesh}
  - {type: traction, on: "two:boundary", traction: [1, 0]}
  - {type: traction, on: y_max, water_level: 1}
  - {type: traction, on: "tow:y_max", pressure: 1}
)yaml");
  const Outcome outcome = talus("check wrong.yaml");
  EXPECT_EQ(outcome.code, 2);
  for (const char* line :
       {"wrong.yaml:10:5: error: loads[0].on: body \"one\" fills no shape, so its sides have no names: sides of regions are facet groups",
        "wrong.yaml:11:5: error: loads[1].on: the shape of body \"two\" has no side \"top\"; it has boundary, x_min, x_max, y_min, y_max",
        "wrong.yaml:12:5: error: loads[2].carried_by: \"two:y_max\" is a side of a body and moves with it: leave carried_by out",
        "wrong.yaml:13:5: error: loads[3].traction: a traction needs a side: \"two:boundary\" is the whole surface, on which a pressure "
        "may act",
        "wrong.yaml:14:5: error: loads[4].water_level: \"y_max\" is a facet group: water acts on sides of bodies that fill a shape",
        "wrong.yaml:15:5: error: loads[5].on: the mesh has no facet group \"tow:y_max\" — did you mean \"two:y_max\"?",
        "6 errors, nothing was run."})
    EXPECT_THAT(outcome.err, HasSubstr(line));
}

TEST_F(Check, WarnsWhereABodyIsThinBehindALoadedSide)
{
  write("thin.yaml", R"yaml(title: Thin
dimension: 2
mesh: {grid: {low: [0, 0], high: [1, 1], cells: [10, 10]}}
time: {end: 1}
materials: [{name: rubber, law: neo_hookean, density: 1, youngs_modulus: 1, poisson_ratio: 0}]
bodies:
  - {name: plate, material: rubber, shape: {type: box, low: [0.1, 0.1], high: [0.9, 0.35]}}
loads:
  - {type: traction, on: "plate:y_max", pressure: 1}
  - {type: traction, on: "plate:x_max", pressure: 1}
)yaml");
  const Outcome outcome = talus("check thin.yaml");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("warning: thin.yaml:9:5: the body is 2.5 cells deep behind \"plate:y_max\""));
  EXPECT_THAT(outcome.err, testing::Not(HasSubstr("thin.yaml:10"))) << "8 cells deep";
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

/// A heap on squares of 0.25 m, whose smallest altitude is 0.25 / sqrt(2) m.
std::string heap(const std::string& law, const std::string& boundary)
{
  return "title: Heap\ndimension: 2\nmesh: {grid: {low: [0, 0], high: [4, 3], cells: [16, 12]}}\nmaterials: [{name: stuff, density: "
         "1000, " +
         law + "}]\nbodies: [{name: heap, material: stuff, shape: {type: box, low: [0, 0], high: [1, 1]}}]\n" +
         "loads: [{type: gravity, acceleration: [0, -5], table: [[0, 0], [1, 2]]}]\nboundaries: [" + boundary + "]\ntime: {end: 1}\n";
}
const std::string elastic = "law: linear_elastic, youngs_modulus: 1.0e6, poisson_ratio: 0.3",
                  soil = "law: mohr_coulomb, youngs_modulus: 1.0e6, poisson_ratio: 0.3, friction_angle: 30, cohesion: 0";

TEST_F(Check, TellsTheDampingOfTheTransferWhichFollowsTheFallWhereABodyFlows)
{
  write("soil.yaml", heap(soil, "{type: fixed, on: y_min}"));
  write("elastic.yaml", heap(elastic, "{type: fixed, on: y_min}"));
  EXPECT_THAT(talus("check soil.yaml").out,
              HasSubstr(fmt::format("transfer aflip, musl, damped in {:.3g} s; in stages that seek rest in 25 "
                                    "crossing times of a cell,",
                                    std::sqrt(0.25 / std::sqrt(2.0) / 10))));
  EXPECT_THAT(talus("check elastic.yaml").out, HasSubstr("transfer aflip, musl, damped in 25 crossing times of a cell,"));
  EXPECT_THAT(talus("check elastic.yaml --set transfer.scheme=saflip").out,
              HasSubstr("transfer saflip, musl, undamped; in stages that seek rest damped in 25 crossing times of a cell,"));
}

TEST_F(Check, NotesAFixedFloorOverWhichSoilMayFlowOut)
{
  constexpr auto note = "\"y_min\" is fixed: what flows out over it is held back";
  write("fixed.yaml", heap(soil, "{type: fixed, on: y_min}"));
  write("rough.yaml", heap(soil, "{type: friction, on: y_min, coefficient: 0.5}, {type: fixed, on: x_min}"));
  write("elastic.yaml", heap(elastic, "{type: fixed, on: y_min}"));
  EXPECT_THAT(talus("check fixed.yaml").out, HasSubstr(note));
  EXPECT_THAT(talus("check rough.yaml").out, testing::Not(HasSubstr("is fixed: what flows")));
  EXPECT_THAT(talus("check elastic.yaml").out, testing::Not(HasSubstr(note)));
}

/// Two blocks in a mesh of squares of 0.25 m, the second from x on.
std::string two_blocks(const std::string& x, const std::string& kernel = "projected")
{
  return "title: Two\ndimension: 2\nkernel: " + kernel +
         "\nmesh: {grid: {low: [0, 0], high: [5, 2], cells: [20, 8]}}\ntime: {end: 0.1}\n"
         "materials: [{name: rubber, law: neo_hookean, density: 1000, youngs_modulus: 1.0e5, poisson_ratio: 0.3}]\n"
         "bodies:\n"
         "  - {name: left, material: rubber, shape: {type: box, low: [0, 0], high: [1, 1]}}\n"
         "  - {name: right, material: rubber, shape: {type: box, low: [" +
         x + ", 0], high: [4, 1]}}\n";
}

TEST_F(Check, TellsBodiesThatShareNodesAcrossAGapFromThoseThatTouch)
{
  write("gap.yaml", two_blocks("1.25"));
  const Outcome gap = talus("check gap.yaml");
  EXPECT_EQ(gap.code, 0) << gap.err;
  EXPECT_THAT(gap.err, HasSubstr("warning: bodies \"left\" and \"right\" are 0.2"));
  EXPECT_THAT(gap.err, testing::ContainsRegex("share [0-9]+ nodes at the start: cells of 0.2"));
  EXPECT_THAT(gap.out, testing::Not(HasSubstr("bodies that touch")));
  write("touch.yaml", two_blocks("1"));
  const Outcome touch = talus("check touch.yaml");
  EXPECT_EQ(touch.err, "");
  EXPECT_THAT(touch.out,
              HasSubstr("  bodies that touch at the start and move as one where they do, without slip: \"left\" and \"right\" ("));
  write("wide.yaml", two_blocks("1.75"));
  const Outcome wide = talus("check wide.yaml");
  EXPECT_EQ(wide.err, "");
  EXPECT_THAT(wide.out, testing::Not(HasSubstr("left\" and \"right")));
  write("linear.yaml", two_blocks("1.5", "linear"));
  EXPECT_EQ(talus("check linear.yaml").err, "") << "its particles act on the nodes of their own cells only";
}

TEST_F(Check, TellsHowFarNodesAreFromTheCentresOfTheirCells)
{
  const auto with = [](const std::string& kernel, const std::string& jitter, const std::string& smoothing) {
    return "title: Uneven\ndimension: 2\nkernel: " + kernel + "\nmesh: {grid: {low: [0, 0], high: [2, 2], cells: [8, 8]" + jitter + "}" +
           smoothing +
           "}\ntime: {end: 0.1}\nmaterials: [{name: rubber, law: neo_hookean, density: 1000, youngs_modulus: 1.0e5, poisson_ratio: 0.3}]\n"
           "bodies: [{name: block, material: rubber, shape: {type: box, low: [0.5, 0], high: [1.5, 1]}}]\n";
  };
  const std::string advice = "  more than 0.12 h in the median: the kernel projected is less accurate on such meshes; mesh.smoothing: 5";
  const auto check = [&](const std::string& scene) {
    write("uneven.yaml", scene);
    const Outcome outcome = talus("check uneven.yaml");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    return outcome.out;
  };
  EXPECT_THAT(check(with("projected", "", "")),
              testing::AllOf(HasSubstr("  interior nodes: 0.000 h from the centre of their cells in the median, up to 0.000 h for 95 %, "),
                             testing::Not(HasSubstr(advice))));
  EXPECT_THAT(check(with("projected", ", jitter: 0.3", "")),
              testing::AllOf(testing::ContainsRegex("interior nodes: 0\\.[12][0-9]+ h from"), HasSubstr(advice)));
  EXPECT_THAT(check(with("projected", ", jitter: 0.3", ", smoothing: 5")),
              testing::AllOf(HasSubstr("interior nodes: 0.00"), testing::Not(HasSubstr(advice))));
  EXPECT_THAT(check(with("umls", ", jitter: 0.3", "")), testing::Not(HasSubstr(advice))) << "its gradients are its own";
  const Outcome mesh = talus("mesh uneven.yaml");
  EXPECT_THAT(mesh.out, testing::AllOf(HasSubstr("\ninterior nodes: 0."), HasSubstr("\n" + advice.substr(2))));
  EXPECT_THAT(talus("mesh uneven.yaml --set mesh.smoothing=5").out, testing::Not(HasSubstr(advice.substr(2))));
}

/// A slope with a slip surface, a bowl, as a raster of its own.
TEST_F(Check, SaysHowManyNodesOfASlipSurfaceAreTreatedAsCornersAndTheSceneRuns)
{
  std::string ground, slip;
  for (std::string* raster : {&ground, &slip})
    *raster = "ncols 33\nnrows 27\nxllcorner -2.5\nyllcorner -2.5\ncellsize 4\nNODATA_value -9999\n";
  for (int row = 0; row < 27; ++row) {
    for (int column = 0; column < 33; ++column) {
      const Real x = 4 * column, y = 4 * (26 - row), height = 100 - 0.3 * x;
      const Real inside = 1 - std::pow((x - 60) / 40, 2) - std::pow((y - 50) / 30, 2);
      ground += std::to_string(height) + " ";
      slip += inside > 0 ? std::to_string(height - 15 * std::sqrt(inside)) + " " : "-9999 ";
    }
    ground += "\n", slip += "\n";
  }
  write("ground.asc", ground);
  write("slip.asc", slip);
  write("bowl.yaml",
        "title: Bowl\ndimension: 3\n"
        "mesh:\n  size: 8\n  terrain: {ground: {file: ground.asc}, layers: [{name: slide, bottom: {file: slip.asc}}], air: {height: 20}}\n"
        "materials: [{name: soil, law: drucker_prager, density: 2000, youngs_modulus: 4.0e+6, poisson_ratio: 0.3, friction_angle: 30, "
        "cohesion: "
        "0, match: plane_strain}]\n"
        "bodies: [{name: slide, material: soil, region: \"layer:slide\"}]\n"
        "loads: [{type: gravity, acceleration: [0, 0, -9.81]}]\n"
        "boundaries: [{type: friction, on: base, coefficient: 0.2}]\n"
        "on_exit: delete\ntime: {end: 0.2}\n");
  const Outcome check = talus("check bowl.yaml");
  ASSERT_EQ(check.code, 0) << check.err;
  EXPECT_THAT(check.out, testing::ContainsRegex("[1-9][0-9]* of [0-9]* nodes lie on curved or creased boundaries"));
  const Outcome run = talus("run bowl.yaml --quiet --out r");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(read("r/summary.json"), testing::ContainsRegex("\"nodes_treated_as_corners\": [1-9]"));
}

TEST_F(Check, ManyBodiesAtTheSamePlaceAreSaidInFewLines)
{
  constexpr int n = 200;
  const auto scene = [](const std::string& where) {
    std::string text = block_scene("");
    text.resize(text.find("  - {name: block"));
    for (int b = 0; b < n; ++b)
      text += fmt::format("  - {{name: b{}, material: rubber, {}, particles_per_cell: 1}}\n", b, where);
    return text + "time: {end: 1}\n";
  };
  const auto lines = [](const std::string& text) { return std::count(text.begin(), text.end(), '\n'); };
  write("boxes.yaml", scene("shape: {type: box, low: [0.5, 0], high: [1.5, 1]}"));
  const Outcome boxes = talus("check boxes.yaml");
  EXPECT_EQ(boxes.code, 0);
  EXPECT_EQ(lines(boxes.err), 11);
  EXPECT_THAT(boxes.err, HasSubstr("warning: 189 more pairs of bodies share cells at the start\n"));
  write("groups.yaml", scene("region: all"));
  const Outcome groups = talus("check groups.yaml");
  EXPECT_EQ(groups.code, 2);
  EXPECT_LT(lines(groups.err), 4 * n) << "one error for each body, not for each pair";
  EXPECT_THAT(groups.err, HasSubstr("body \"b0\" fills the cell group \"all\" already"));
}

}  // namespace

}  // namespace talus::check_test
