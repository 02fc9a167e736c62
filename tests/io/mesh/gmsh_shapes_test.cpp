// Regions with holes, rings and shapes put together from others, and the groups of their sides.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "mesh/digest.hpp"
#include "mesh/quality.hpp"
#include "tests/io/mesh/mesh_measures.hpp"
#include "tests/io/scratch_folder.hpp"

namespace talus::gmsh_shapes_test {
namespace {

using ::testing::HasSubstr;

MeshSpec region(Real size, Shape shape)
{
  MeshSpec spec;
  spec.where = SourceLocation{"scene.yaml", 3, 7, "mesh"};
  spec.size = size;
  spec.regions = {{"rock", std::move(shape), SourceLocation{"scene.yaml", 5, 9, "mesh.regions[0]"}}};
  return spec;
}

/// Every particle of a mesh must lie in the shape that was meshed: the mesher and the test of points mean the same.
template <int D>
void expect_cells_in_shape(const Mesh<D>& mesh, const Shape& shape)
{
  for (Index c = 0; c < mesh.n_cells(); ++c) {
    Vec<D> centre = Vec<D>::Zero();
    for (const Index n : mesh.cell(c))
      centre += mesh.node(n) / (D + 1);
    ASSERT_TRUE(contains(shape, std::span<const Real>(centre.data(), D))) << "cell " << c;
  }
}

constexpr Real round_off = 1e-10;  // relative, of coordinates and sums

const Polygon tunnel{{{0, 0}, {6, 0}, {4, 4}, {0, 4}}, {}, {{{1, 1}, {3, 1}, {3, 2}, {1, 2}}}, {"base", "slope", "top", "back"}};

TEST(GmshShapes, PolygonWithAHoleAndNamedSides)
{
  const Mesh<2> mesh = load_mesh<2>(region(0.5, tunnel), ".");
  EXPECT_NEAR(volume_of(mesh, "rock"), 20 - 2, round_off * 20);
  expect_cells_in_shape(mesh, tunnel);
  EXPECT_NEAR(area_of(mesh, "rock:base"), 6, round_off * 6);
  EXPECT_NEAR(area_of(mesh, "rock:slope"), std::hypot(2, 4), round_off * 6);
  EXPECT_NEAR(area_of(mesh, "rock:top"), 4, round_off * 6);
  EXPECT_NEAR(area_of(mesh, "rock:back"), 4, round_off * 6);
  EXPECT_NEAR(area_of(mesh, "rock:hole_1"), 6, round_off * 6);
}

/// Regions, their sides and outlines stay, the nodes between come closer to the centres of their cells, equal specs give equal meshes.
TEST(GmshShapes, SmoothingKeepsTheRegionsAndTheirSides)
{
  MeshSpec spec = region(0.2, Sphere{{1, 1, 1}, 0.6});
  spec.regions.push_back({"room", Box{{0, 0, 0}, {2, 2, 2}}, spec.where});
  const Mesh<3> plain = load_mesh<3>(spec, ".");
  spec.smoothing = 5;
  const Mesh<3> smooth = load_mesh<3>(spec, ".");
  EXPECT_EQ(digest(smooth), digest(load_mesh<3>(spec, ".")));
  EXPECT_NE(digest(smooth), digest(plain));
  for (const char* name : {"rock", "room"})
    EXPECT_NEAR(volume_of(smooth, name), volume_of(plain, name), round_off);
  for (const std::string& name : plain.facet_set_names())
    EXPECT_NEAR(area_of(smooth, name), area_of(plain, name), round_off) << name;
  EXPECT_LT(star_offsets(smooth).median, 0.5 * star_offsets(plain).median);
  EXPECT_GE(quality(smooth).smallest_altitude, quality(plain).smallest_altitude * (1 - round_off));
}

TEST(GmshShapes, ExtrudedPolygonHasItsHoleAndItsSides)
{
  Polygon solid = tunnel;
  solid.extrude = {-1, 1};
  const Mesh<3> mesh = load_mesh<3>(region(1, solid), ".");
  EXPECT_NEAR(volume_of(mesh, "rock"), 2 * 18, round_off * 36);
  expect_cells_in_shape(mesh, solid);
  EXPECT_NEAR(area_of(mesh, "rock:slope"), 2 * std::hypot(2, 4), round_off * 12);
  EXPECT_NEAR(area_of(mesh, "rock:hole_1"), 2 * 6, round_off * 12);
}

TEST(GmshShapes, SidesOfOneNameAreOneAndSidesBetweenRegionsCount)
{
  Polygon lower{{{0, 0}, {4, 0}, {4, 1}, {0, 1}}, {}, {}, {"rim", "rim", "joint", "rim"}};
  MeshSpec spec = region(0.5, lower);
  spec.regions.push_back({"soil", Box{{0, 1}, {4, 2}}, SourceLocation{}});
  const Mesh<2> mesh = load_mesh<2>(spec, ".");
  EXPECT_NEAR(area_of(mesh, "rock:rim"), 6, round_off * 6);
  EXPECT_NEAR(area_of(mesh, "rock:joint"), 4, round_off * 6);
  const auto joint = mesh.facet_set("rock:joint");
  for (const Facet f : joint.value())
    EXPECT_FALSE(mesh.on_boundary(f));
}

TEST(GmshShapes, ASideThatIsNotThereIsRefused)
{
  MeshSpec spec = region(0.5, Box{{0, 0}, {2, 2}});
  spec.regions.push_back({"more", Polygon{{{1, 0.5}, {3, 0.5}, {3, 1.5}, {1, 1.5}}, {}, {}, {"a", "b", "c", "inside"}},
                          SourceLocation{"scene.yaml", 8, 9, "mesh.regions[1]"}});
  EXPECT_THAT(complaint<2>(spec),
              HasSubstr("scene.yaml:8:9: error: mesh.regions[1]: no facet of region \"more\" lies on its side \"inside\""));
}

TEST(GmshShapes, RingIsHollowAndItsInsideIsAGroup)
{
  const Ring ring{{1, 2}, 0.5, 2};
  const Mesh<2> mesh = load_mesh<2>(region(0.2, ring), ".");
  const Real exact = std::numbers::pi * (4 - 0.25);
  EXPECT_NEAR(volume_of(mesh, "rock"), exact, 0.01 * exact);  // chords
  EXPECT_NEAR(area_of(mesh, "rock:inner"), std::numbers::pi, 0.03 * std::numbers::pi);
  EXPECT_GT(area_of(mesh, "rock:boundary"), 0.98 * std::numbers::pi * 5);
}

TEST(GmshShapes, RingIn3DIsAHollowBall)
{
  const Mesh<3> mesh = load_mesh<3>(region(0.4, Ring{{0, 0, 0}, 0.5, 1.5}), ".");
  const Real exact = 4.0 / 3 * std::numbers::pi * (std::pow(1.5, 3) - std::pow(0.5, 3));
  EXPECT_NEAR(volume_of(mesh, "rock"), exact, 0.08 * exact);
  EXPECT_NEAR(area_of(mesh, "rock:inner"), std::numbers::pi, 0.15 * std::numbers::pi);
}

TEST(GmshShapes, DifferenceUnionAndIntersection)
{
  const Box block{{0, 0}, {4, 2}};
  const Difference cut{block, {Box{{1, 1}, {2, 3}}, Polygon{{{2, -1}, {5, -1}, {5, 2}}, {}}}};
  const Mesh<2> less = load_mesh<2>(region(0.4, cut), ".");
  EXPECT_NEAR(volume_of(less, "rock"), 8 - 1 - 0.5, round_off * 8);
  expect_cells_in_shape(less, cut);
  const Union both{{block, Box{{3, 1}, {5, 4}}}};
  const Mesh<2> more = load_mesh<2>(region(0.4, both), ".");
  EXPECT_NEAR(volume_of(more, "rock"), 8 + 6 - 1, round_off * 13);
  expect_cells_in_shape(more, both);
  const Intersection common{{block, Box{{3, 1}, {5, 4}}, Sphere{{3.5, 1.5}, 5}}};
  const Mesh<2> part = load_mesh<2>(region(0.4, common), ".");
  EXPECT_NEAR(volume_of(part, "rock"), 1, round_off);
  expect_cells_in_shape(part, common);
}

TEST(GmshShapes, AShaftIn3DIsACylinderLessAnother)
{
  const Difference shaft{Box{{-2, -2, 0}, {2, 2, 3}}, {Cylinder{{0, 0, 1}, {0, 0, 4}, 1}}};
  const Mesh<3> mesh = load_mesh<3>(region(0.7, shaft), ".");
  EXPECT_NEAR(volume_of(mesh, "rock"), 48 - 2 * std::numbers::pi, 0.5);
}

TEST(GmshShapes, NothingLeftIsRefusedAtTheRegion)
{
  const Box block{{0, 0}, {1, 1}};
  EXPECT_THAT(complaint<2>(region(0.4, Difference{block, {Box{{-1, -1}, {2, 2}}}})),
              HasSubstr("scene.yaml:5:9: error: mesh.regions[0]: region \"rock\": nothing is left of the shape without the others"));
  EXPECT_THAT(complaint<2>(region(0.4, Intersection{{block, Box{{2, 2}, {3, 3}}}})), HasSubstr("the shapes have nothing in common"));
}

/// The facets of a group that face a direction.
TEST(GmshShapes, GroupsFaceADirection)
{
  MeshSpec spec = region(0.5, tunnel);
  const SourceLocation where{"scene.yaml", 9, 5, "mesh.groups[0]"};
  spec.groups = {{"up", "boundary", {}, where, {0, 1}, 30},
                 {"slope", "rock:boundary", {}, where, {2, 1}, 5},
                 {"floor of the tunnel", "rock:hole_1", {}, where, {0, 1}, 1}};
  const Mesh<2> mesh = load_mesh<2>(spec, ".");
  EXPECT_NEAR(area_of(mesh, "up"), 4 + 2, round_off * 6) << "the top, and the floor of the hole: the normal points out of the rock";
  EXPECT_NEAR(area_of(mesh, "slope"), std::hypot(2, 4), round_off * 6);
  EXPECT_NEAR(area_of(mesh, "floor of the tunnel"), 2, round_off * 6);
  spec.groups = {{"none", "rock:slope", {}, where, {0, -1}, 30}};
  EXPECT_THAT(complaint<2>(spec),
              HasSubstr("scene.yaml:9:5: error: mesh.groups[0]: group \"none\": no facet of \"rock:slope\" faces (0, -1) up to 30 deg"));
}

/// A .msh of two triangles per square.
class Msh : public ::testing::Test {
 protected:
  MeshSpec file(const std::string& more_nodes, const std::string& more_elements, int nodes, int elements) const
  {
    std::ofstream(folder_ / "m.msh")
        << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"soil\"\n2 2 \"also\"\n$EndPhysicalNames\n"
        << "$Nodes\n"
        << 6 + nodes << "\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n5 1 1 0\n6 2 1 0\n"
        << more_nodes << "$EndNodes\n$Elements\n"
        << 2 + elements << "\n1 2 2 1 1 1 2 5\n2 2 2 1 1 1 5 4\n"
        << more_elements << "$EndElements\n";
    MeshSpec spec;
    spec.where = SourceLocation{"scene.yaml", 3, 7, "mesh"};
    spec.file = "m.msh";
    return spec;
  }
  ScratchFolder folder_;
};

TEST_F(Msh, CellsThatAreThereTwiceAreToldUnlessAnotherGroupNamesThem)
{
  const auto in_two_groups = load_mesh<2>(file("", "3 2 2 2 1 1 2 5\n", 0, 1), folder_.path());
  EXPECT_EQ(in_two_groups.n_cells(), 2);
  EXPECT_TRUE(in_two_groups.notes().empty());
  const auto twice = load_mesh<2>(file("", "3 2 2 1 1 2 5 1\n", 0, 1), folder_.path());
  EXPECT_EQ(twice.n_cells(), 2);
  ASSERT_EQ(twice.notes().size(), 1);
  EXPECT_THAT(
      twice.notes()[0],
      HasSubstr("scene.yaml:3:7: mesh file \"m.msh\": 1 of 2 cells are in the file more than once, the first at (0.666667, 0.333333)"));
}

TEST_F(Msh, CellsThatOverlapWithoutACommonFacetAreRefused)
{
  EXPECT_THAT(complaint<2>(file("7 0.2 -0.5 0\n8 0.8 -0.5 0\n9 0.5 0.4 0\n", "3 2 2 2 1 7 8 9\n", 3, 1), folder_.path()),
              HasSubstr("scene.yaml:3:7: error: mesh: mesh file \"m.msh\": cells overlap although they share no facet: 1 pair, the first "
                        "near (0.583333, 0.0666667), one cell of \"also\", the other of \"soil\""));
}

TEST_F(Msh, NodesAtOnePlaceThatAreNotJoinedAreTold)
{
  const auto cracked = load_mesh<2>(file("7 1 0 0\n8 1 1 0\n", "3 2 2 1 1 7 3 6\n4 2 2 1 1 7 6 8\n", 2, 2), folder_.path());
  ASSERT_EQ(cracked.notes().size(), 1);
  EXPECT_THAT(cracked.notes()[0],
              HasSubstr("at 2 places there is more than one node, the first at (1, 0): the cells there are not joined"));
}

}  // namespace
}  // namespace talus::gmsh_shapes_test
