// Rigid bodies of a scene: what is refused, and what a run writes.
#include <gmock/gmock.h>

#include "io/output/csv.hpp"
#include "io/output/vtk.hpp"
#include "tests/app/program.hpp"

namespace talus::rigid_test {
namespace {

using testing::HasSubstr;

std::string block_and(const std::string& rigid, bool solid = false)
{
  const std::string three = solid ? ", 0" : "", wide = solid ? ", 2" : "";
  return "title: Block\ndimension: " + std::string(solid ? "3" : "2") + "\nmesh: {grid: {low: [0, 0" + three + "], high: [2, 2" + wide +
         "], cells: [4, 4" + (solid ? ", 4" : "") + "]}}\n" +
         "materials: [{name: rubber, law: neo_hookean, density: 1000, youngs_modulus: 1.0e5, poisson_ratio: 0.3}]\n"
         "bodies:\n  - {name: block, material: rubber, shape: {type: box, low: [0, 0" +
         three + "], high: [2, 1" + wide + "]}, particles_per_cell: 4}\n" + "loads: [{type: gravity, acceleration: [0, -9.81" + three +
         "]}]\n"
         "boundaries: [{type: fixed, on: y_min}]\ntime: {end: 0.02, max_step: 2.0e-3}\n"
         "outputs: {history: {every: 0.01}, particles: {every: 0.01}}\nrigid:\n" +
         rigid;
}

class RigidOfScene : public Program {
 protected:
  Outcome check(const std::string& rigid, bool solid = false)
  {
    write("scene.yaml", block_and(rigid, solid));
    return talus("check scene.yaml");
  }
};

TEST_F(RigidOfScene, WhatCannotBeIsRefusedWithItsPlace)
{
  const Outcome outcome = check(
      "  - {name: block, shape: {type: sphere, centre: [1, 1.5], radius: 0.3}, mass: 1}\n"
      "  - {name: a, shape: {type: sphere, centre: [1, 1.5, 0], radius: 0.3}, mass: 1, density: 2}\n"
      "  - {name: a, mass: 1}\n"
      "  - {name: b, shape: {type: ring, centre: [1, 1.5], inner_radius: 0.1, radius: 0.3}}\n"
      "  - {name: c, file: stone.stl, mass: 1, inertia: [1, 2, 3], friction: -1}\n"
      "  - {name: d, shape: {type: sphere, centre: [1, 1.5], radius: 0.3}, mass: 1, table: [[0, 1]]}\n");
  EXPECT_EQ(outcome.code, 2);
  for (const char* const words :
       {"rigid[0] \"block\".name: \"block\" is the name of a body already", "rigid[1] \"a\": give mass or density, not both",
        "rigid[1] \"a\".shape.centre: needs 2 values in 2 dimensions, not 3",
        "rigid[2] \"a\": give one of shape, file, sheet and sheet_file", "rigid[2] \"a\".name: \"a\" is the name of rigid[1] already",
        "rigid[3] \"b\": a free body needs mass or density", "rigid[3] \"b\".shape: a rigid body is a box, sphere, cylinder or polygon",
        "rigid[4] \"c\".file: an STL file is a surface in space", "rigid[4] \"c\".inertia: needs 1 value in 2 dimensions, not 3",
        "rigid[5] \"d\": a table is of a given motion", "rigid[4] \"c\".friction: -1 must be >= 0"})
    EXPECT_THAT(outcome.err, HasSubstr(words));
  EXPECT_THAT(outcome.err, HasSubstr("scene.yaml:12:12: error: rigid[0] \"block\".name"));
}

TEST_F(RigidOfScene, SheetsThatCannotBeAreRefused)
{
  const Outcome outcome = check(
      "  - {name: a, sheet: [[1, 2]], density: 3}\n"
      "  - {name: b, sheet: [[1, 2], [1, 2], [1, 0, 0]], motion: given}\n"
      "  - {name: c, sheet_file: blade.stl, motion: given}\n"
      "contacts: [{between: [block, other]}]\nprojected: {surfaces: extended}\n");
  EXPECT_EQ(outcome.code, 2);
  for (const char* const words :
       {"scene.yaml:12:5: error: rigid[0] \"a\": a sheet has no volume: give its mass instead of a density",
        "rigid[0] \"a\".sheet: a sheet needs at least 2 points in 2 dimensions, not 1", "rigid[1] \"b\".sheet[1]: repeats the point before",
        "rigid[1] \"b\".sheet[2]: needs 2 values in 2 dimensions, not 3",
        "rigid[2] \"c\".sheet_file: an STL file is a surface in space: in 2 dimensions give the points of a sheet",
        "rigid[0] \"a\".sheet: sheets and contacts of bodies cannot act in one scene yet",
        "rigid[0] \"a\".sheet: beside a sheet gradients are not extended"})
    EXPECT_THAT(outcome.err, HasSubstr(words));
  EXPECT_THAT(check("  - {name: d, sheet: [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.5]], motion: given}\n", true).err,
              HasSubstr("rigid[0] \"d\".sheet: the corners of a sheet have to be those of a flat convex polygon"));
  EXPECT_THAT(check("  - {name: e, sheet: [[0, 0, 0], [1, 1, 0], [0.3, 0.3, 0]], motion: given}\n", true).err,
              HasSubstr("scene.yaml:12:5: error: rigid[0] \"e\".sheet: the corners of a sheet lie on a line"));
}

TEST_F(RigidOfScene, ASheetIsDrawnAndSaysWhatItIs)
{
  const Outcome outcome = check("  - {name: pile, sheet: [[1, 1.8], [1, 0.5], [1.2, 0.3]], mass: 5, velocity: [1, 0]}\n");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("rigid body \"pile\": 5 kg, free, a sheet of 2 facets, friction 0"));
  ASSERT_EQ(talus("run scene.yaml --out out").code, 0);
  const StoredMesh drawn = read_mesh(folder_ / "out/rigid_0000.vtu");
  EXPECT_EQ(drawn.corners.size(), 2 * 2 * 3u) << "two triangles a segment";
}

TEST_F(RigidOfScene, SolidsThatFitBetweenThePointsOfASheetAreWarnedOf)
{
  const auto stone = [](const std::string& width) {
    return "  - {name: shelf, sheet: [[0.1, 1.3], [1.9, 1.3]], motion: given}\n"
           "  - {name: stone, shape: {type: box, low: [1, 1.5], high: [" +
           width + "]}, mass: 1}\n";
  };
  EXPECT_THAT(check(stone("1.05, 1.55")).err, HasSubstr("\"stone\", 0.05 m wide, may pass through the sheet \"shelf\""));
  EXPECT_THAT(check(stone("1.2, 1.7")).err, testing::Not(HasSubstr("may pass through")));
}

TEST_F(RigidOfScene, ARestartRefusesAnotherSurface)
{
  const auto tetrahedron = [](const std::string& top) {
    const auto facet = [](const std::string& a, const std::string& b, const std::string& c) {
      return "facet normal 0 0 0\nouter loop\nvertex " + a + "\nvertex " + b + "\nvertex " + c + "\nendloop\nendfacet\n";
    };
    const std::string o = "0 0 0", x = "0.5 0 0", y = "0 0.5 0";
    return "solid s\n" + facet(o, y, x) + facet(o, top, y) + facet(o, x, top) + facet(x, y, top) + "endsolid s\n";
  };
  write("stone.stl", tetrahedron("0 0 0.5"));
  write("scene.yaml", block_and("  - {name: stone, file: stone.stl, at: [0.5, 1.2, 0.5], density: 2000}\n", true));
  ASSERT_EQ(talus("run scene.yaml --quiet --out out --until 2").code, 4) << read("err.txt");
  write("stone.stl", tetrahedron("0 0 0.4"));
  const Outcome refused = talus("run --resume out --quiet");
  EXPECT_EQ(refused.code, 3);
  EXPECT_THAT(refused.err, HasSubstr("the surface of a rigid body is not the one that the checkpoint was made with"));
  write("stone.stl", tetrahedron("0 0 0.5"));
  EXPECT_EQ(talus("run --resume out --quiet").code, 0) << read("err.txt");
}

TEST_F(RigidOfScene, BodiesThatBeginInsideOthersAreRefused)
{
  const Outcome outcome = check(
      "  - {name: low, shape: {type: sphere, centre: [1, 1.2], radius: 0.3}, mass: 1}\n"
      "  - {name: high, shape: {type: box, low: [1, 1.4], high: [1.5, 1.8]}, mass: 1}\n"
      "  - {name: deep, shape: {type: box, low: [1.6, -0.2], high: [1.9, 1]}, mass: 1}\n");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, testing::ContainsRegex("rigid\\[0\\] .low..name: [0-9]+ particles? of \"block\" begins? inside \"low\""));
  EXPECT_THAT(outcome.err, HasSubstr("rigid[1] \"high\".name: \"high\" begins 0.1 m inside \"low\""));
  EXPECT_THAT(outcome.err, HasSubstr("rigid[2] \"deep\".name: \"deep\" begins 0.2 m inside a wall of the mesh"));
}

TEST_F(RigidOfScene, AFileThatIsOpenOrInsideOutIsRefused)
{
  const auto facet = [](const std::string& a, const std::string& b, const std::string& c) {
    return "facet normal 0 0 0\nouter loop\nvertex " + a + "\nvertex " + b + "\nvertex " + c + "\nendloop\nendfacet\n";
  };
  const std::string o = "0 0 0", x = "0.5 0 0", y = "0 0.5 0", z = "0 0 0.5";
  const std::string three = facet(o, y, x) + facet(o, z, y) + facet(o, x, z);
  write("whole.stl", "solid s\n" + three + facet(x, y, z) + "endsolid s\n");
  write("open.stl", "solid s\n" + three + "endsolid s\n");
  write("turned.stl", "solid s\n" + facet(o, x, y) + facet(o, y, z) + facet(o, z, x) + facet(x, z, y) + "endsolid s\n");
  const auto stone = [&](const std::string& file) {
    return check("  - {name: stone, file: " + file + ", at: [0.5, 1.2, 0.5], density: 2000}\n", true);
  };
  EXPECT_EQ(stone("whole.stl").code, 0) << read("err.txt");
  EXPECT_THAT(stone("whole.stl").out, HasSubstr("rigid body \"stone\": 41.6667 kg, free, 4 facets"));
  EXPECT_THAT(stone("open.stl").err, HasSubstr("error: rigid[0] \"stone\".file: the surface is open"));
  EXPECT_THAT(stone("turned.stl").err, HasSubstr("error: rigid[0] \"stone\".file: the surface is inside out"));
  EXPECT_EQ(stone("none.stl").code, 2);
  EXPECT_THAT(read("err.txt"), HasSubstr("none.stl"));
}

TEST_F(RigidOfScene, AFreeBodyThatLeavesTheMeshStopsTheRunUnlessItMayGo)
{
  const std::string scene =
      block_and("  - {name: ball, shape: {type: sphere, centre: [1.9, 1.6], radius: 0.3}, mass: 1, velocity: [20, 0]}\n");
  write("scene.yaml", scene);
  const Outcome outcome = talus("run scene.yaml --quiet --out out");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("the rigid body \"ball\" has left the mesh at (2.0"));
  EXPECT_THAT(outcome.err, HasSubstr("last good output"));
  write("scene.yaml", "on_exit: delete\n" + scene);
  EXPECT_EQ(talus("run scene.yaml --quiet --out gone").code, 0) << read("err.txt");
}

TEST_F(RigidOfScene, ARunWritesItsPlaceItsForcesAndItsSurface)
{
  write("scene.yaml",
        block_and("  - {name: ball, shape: {type: sphere, centre: [1, 1.345], radius: 0.3}, density: 500, velocity: [1, -3]}\n"
                  "  - {name: ram, shape: {type: polygon, points: [[0, 1.5], [0, 1.8], [0.6, 1.8], [0.1, 1.7]]}, motion: given, "
                  "velocity: [0.5, 0]}\n"));
  ASSERT_EQ(talus("run scene.yaml --quiet --out out").code, 0) << read("err.txt");
  const HistoryTable table = read_history(folder_ / "out/history.csv");
  EXPECT_NEAR((*table["rigid_ball_x"])[1], 1.01, 1e-3);
  EXPECT_LT((*table["rigid_ball_vy"])[1], -2.9);
  EXPECT_GT((*table["rigid_ball_vy"])[2], -2.9) << "it has met the block";
  EXPECT_GT((*table["rigid_ball_fy"])[2], 0);
  EXPECT_EQ((*table["rigid_ball_wz"])[0], 0);
  EXPECT_NEAR((*table["kinetic_rigid_ball"])[0], 0.5 * 500 * std::numbers::pi * 0.09 * 10, 1e-6);
  EXPECT_NEAR((*table["rigid_ram_x"])[2] - (*table["rigid_ram_x"])[0], 0.01, 1e-12);
  EXPECT_EQ(read_pvd(folder_ / "out/rigid.pvd").size(), 3u);
  const StoredMesh surface = read_mesh(folder_ / "out/rigid_0002.vtu");
  Real area = 0;
  for (std::size_t c = 0; c < surface.corners.size(); c += 3) {
    const auto at = [&](std::size_t k) { return surface.nodes.data() + 3 * static_cast<std::size_t>(surface.corners[c + k]); };
    const Real part = 0.5 * ((at(1)[0] - at(0)[0]) * (at(2)[1] - at(0)[1]) - (at(1)[1] - at(0)[1]) * (at(2)[0] - at(0)[0]));
    EXPECT_GT(part, 0);
    area += part;
  }
  const Real of_ball = 0.5 * 48 * std::sin(2 * std::numbers::pi / 48) * 0.09, of_ram = 0.045;
  EXPECT_NEAR(area, of_ball + of_ram, 1e-6);
}

}  // namespace
}  // namespace talus::rigid_test
