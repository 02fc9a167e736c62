// Meshes of scenes: inline regions, geometry files, refinement, grids and the groups named on top.
#include "io/load_mesh.hpp"

#include <gmock/gmock.h>
#include <gmsh.h>
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "core/parallel/threads.hpp"
#include "tests/io/mesh/mesh_measures.hpp"
#include "tests/io/scratch_folder.hpp"

namespace talus::gmsh_mesh_test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

const SourceLocation place_of_mesh{"scene.yaml", 3, 7, "mesh"};

RegionSpec region(const std::string& name, Shape shape)
{
  return {name, std::move(shape), SourceLocation{"scene.yaml", 5, 9, "mesh.regions"}};
}

MeshSpec regions(Real size, std::vector<RegionSpec> list)
{
  MeshSpec spec;
  spec.where = place_of_mesh;
  spec.size = size;
  spec.regions = std::move(list);
  return spec;
}

constexpr Real round_off = 1e-12;  // relative, of sums over some thousand cells

TEST(GmshMesh, LeavesTheNumberOfThreadsAlone)
{
  const int before = threads();
  set_threads(3);
  load_mesh<2>(regions(0.5, {region("a", Box{{0, 0}, {1, 1}})}), ".");
  EXPECT_EQ(threads(), 3) << "gmsh sets it for the whole program";
  set_threads(before);
}

TEST(GmshMesh, PlaneRegionsHaveTheirAreas)
{
  const Mesh<2> mesh = load_mesh<2>(regions(0.1, {region("box", Box{{0, 0}, {2, 1}}), region("disk", Sphere{{4, 0}, 1}),
                                                  region("wedge", Polygon{{{0, 1}, {2, 1}, {0, 2}}, {}})}),
                                    ".");
  EXPECT_NEAR(volume_of(mesh, "box"), 2, 2 * round_off);
  EXPECT_NEAR(volume_of(mesh, "wedge"), 1, round_off);
  // A chord of length h cuts h^3 / (12 r) off a disk: of the area pi a share of h^2 / 6 in all.
  EXPECT_LT(volume_of(mesh, "disk"), std::numbers::pi);
  EXPECT_NEAR(volume_of(mesh, "disk"), std::numbers::pi, std::numbers::pi * 0.1 * 0.1 / 6 * 1.1);
}

TEST(GmshMesh, SolidRegionsHaveTheirVolumes)
{
  const Real h = 0.2;
  const Mesh<3> mesh = load_mesh<3>(
      regions(h, {region("box", Box{{0, 0, 0}, {1, 1, 1}}), region("ball", Sphere{{3, 0, 0}, 1}),
                  region("pipe", Cylinder{{0, 0, 2}, {0, 1, 2}, 0.5}), region("prism", Polygon{{{0, 3}, {1, 3}, {0, 4}}, {1, 2}})}),
      ".");
  EXPECT_NEAR(volume_of(mesh, "box"), 1, round_off);
  EXPECT_NEAR(volume_of(mesh, "prism"), 0.5, round_off);
  // Flat faces with edges h leave out about a share of h^2 / (2 r^2) of a ball, chords h^2 / (6 r^2) of a cylinder.
  const Real ball = 4 * std::numbers::pi / 3, pipe = std::numbers::pi / 4;
  EXPECT_LT(volume_of(mesh, "ball"), ball);
  EXPECT_NEAR(volume_of(mesh, "ball"), ball, ball * h * h / 2);
  EXPECT_LT(volume_of(mesh, "pipe"), pipe);
  EXPECT_NEAR(volume_of(mesh, "pipe"), pipe, pipe * h * h / (6 * 0.25) * 1.1);
}

TEST(GmshMesh, RegionsThatTouchShareTheirFacesAndTheLaterGivesWay)
{
  const Mesh<2> mesh = load_mesh<2>(regions(0.25, {region("soil", Box{{0, 0}, {2, 1}}), region("air", Box{{0, 0}, {2, 3}})}), ".");
  EXPECT_NEAR(volume_of(mesh, "soil"), 2, 2 * round_off);
  EXPECT_NEAR(volume_of(mesh, "air"), 4, 4 * round_off);
  std::vector<std::uint8_t> in_soil(static_cast<std::size_t>(mesh.n_cells()), 0);
  const auto soil = mesh.cell_set("soil");
  for (const Index c : *soil)
    in_soil[c] = 1;
  Real shared = 0;
  for (const Index c : *soil)
    for (Index a = 0; a < 3; ++a)
      if (const Index other = mesh.neighbours(c)[a]; other != none && in_soil[other] == 0)
        shared += mesh.area_vector({c, a}).norm();
  EXPECT_NEAR(shared, 2, 2 * round_off);
  const auto hull = mesh.facet_set("boundary");
  Real around = 0;
  for (const Facet f : *hull)
    around += mesh.area_vector(f).norm();
  EXPECT_NEAR(around, 10, 10 * round_off);
}

template <int D>
void refines(const MeshSpec& coarse)
{
  MeshSpec fine = coarse;
  fine.refine = {{Box{std::vector<Real>(D, 0.0), std::vector<Real>(D, 0.3)}, *coarse.size / 4}};
  const auto mean_size = [](const Mesh<D>& mesh, bool inside) {
    Real sum = 0;
    int count = 0;
    for (Index n = 0; n < mesh.n_nodes(); ++n)
      if (inside ? mesh.node(n).maxCoeff() < 0.25 : mesh.node(n).minCoeff() > 0.8) {
        sum += mesh.node_size(n);
        ++count;
      }
    return sum / count;
  };
  const Mesh<D> plain = load_mesh<D>(coarse, "."), refined = load_mesh<D>(fine, ".");
  EXPECT_NEAR(mean_size(refined, true), *coarse.size / 4, 0.3 * *coarse.size / 4);
  EXPECT_GT(mean_size(plain, true), 2.5 * mean_size(refined, true));
  EXPECT_NEAR(mean_size(refined, false), mean_size(plain, false), 0.3 * mean_size(plain, false));
}
TEST(GmshMesh, PlaneMeshIsFinerInTheBoxOnly) { refines<2>(regions(0.1, {region("all", Box{{0, 0}, {1, 1}})})); }
TEST(GmshMesh, SolidMeshIsFinerInTheBoxOnly) { refines<3>(regions(0.2, {region("all", Box{{0, 0, 0}, {1, 1, 1}})})); }

template <int D>
void repeats(const MeshSpec& spec)
{
  const MeshData<D> first = make_mesh<D>(spec, "."), second = make_mesh<D>(spec, ".");
  EXPECT_EQ(first.nodes, second.nodes);
  EXPECT_EQ(first.cells, second.cells);
  EXPECT_EQ(first.facet_sets, second.facet_sets);
  EXPECT_EQ(first.cell_sets, second.cell_sets);
}
TEST(GmshMesh, MeshingAPlaneTwiceGivesTheSameBits)
{
  repeats<2>(regions(0.1, {region("a", Box{{0, 0}, {1, 1}}), region("b", Sphere{{1, 1}, 0.5}), region("c", Box{{-1, 0}, {0, 2}})}));
}
TEST(GmshMesh, MeshingSolidsTwiceGivesTheSameBits)
{
  repeats<3>(
      regions(0.2, {region("a", Box{{0, 0, 0}, {1, 1, 1}}), region("b", Sphere{{1, 1, 1}, 0.5}), region("c", Box{{-1, 0, 0}, {0, 1, 1}})}));
}

TEST(GmshMesh, SolidMeshesHaveNoSlivers)
{
  const Mesh<3> mesh = load_mesh<3>(regions(0.12, {region("a", Box{{0, 0, 0}, {1, 1, 1}}), region("b", Sphere{{1, 0.5, 0.5}, 0.3})}), ".");
  Real worst = 1;
  for (Index c = 0; c < mesh.n_cells(); ++c) {
    Real squares = 0;
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < a; ++b)
        squares += (mesh.node(mesh.cell(c)[a]) - mesh.node(mesh.cell(c)[b])).squaredNorm();
    // Mean ratio: one for a regular tetrahedron, zero for a flat one.
    worst = std::min(worst, 12 * std::cbrt(9 * mesh.volume(c) * mesh.volume(c)) / squares);
  }
  EXPECT_GT(worst, 0.2);
}

TEST(GmshMesh, BoundingBoxHullAndOutlinesHaveNames)
{
  const Mesh<3> mesh =
      load_mesh<3>(regions(0.5, {region("low", Box{{0, 0, 0}, {1, 2, 1}}), region("high", Box{{0, 0, 1}, {1, 2, 3}})}), ".");
  EXPECT_THAT(mesh.facet_set_names(),
              UnorderedElementsAre("x_min", "x_max", "y_min", "y_max", "z_min", "z_max", "boundary", "low:boundary", "high:boundary"));
  const auto area = [&](const std::string& name) {
    const auto facets = mesh.facet_set(name);
    Real sum = 0;
    for (const Facet f : facets.value())
      sum += mesh.area_vector(f).norm();
    return sum;
  };
  EXPECT_NEAR(area("x_min"), 6, 6 * round_off);
  EXPECT_NEAR(area("y_max"), 3, 3 * round_off);
  EXPECT_NEAR(area("z_min"), 2, 2 * round_off);
  EXPECT_NEAR(area("boundary"), 22, 22 * round_off);
  EXPECT_NEAR(area("low:boundary"), 10, 10 * round_off);
  EXPECT_NEAR(area("high:boundary"), 16, 16 * round_off);
}

MeshSpec grid()
{
  MeshSpec spec;
  spec.where = place_of_mesh;
  spec.grid = GridSpec{{0, 0}, {2, 1}, {4, 2}, 0};
  return spec;
}

TEST(GmshMesh, GridIsABoxWithNamedSides)
{
  const Mesh<2> mesh = load_mesh<2>(grid(), ".");
  EXPECT_EQ(mesh.n_cells(), 16);
  EXPECT_THAT(mesh.facet_set_names(), Contains("x_max"));
}

TEST(GmshMesh, GroupsOfTheSceneNameBoundaryFacetsInBoxes)
{
  MeshSpec spec = grid();
  spec.groups = {{"footing", "boundary", Box{{0.4, 0.9}, {1.6, 1.1}}, SourceLocation{"scene.yaml", 9, 5, ""}}};
  const Mesh<2> mesh = load_mesh<2>(spec, ".");
  const auto facets = mesh.facet_set("footing");
  ASSERT_EQ(facets.value().size(), 2U);
  for (const Facet f : *facets)
    EXPECT_EQ(mesh.area_vector(f), Vec<2>(0, 0.5));
}

/// Soil below air, with the facets of `of` that lie on the surface between them as group "surface".
MeshSpec surface_of(const std::string& of)
{
  MeshSpec spec = regions(0.25, {region("soil", Box{{0, 0}, {2, 1}}), region("air", Box{{0, 1}, {2, 2}})});
  spec.groups = {{"surface", of, Box{{-0.1, 0.9}, {2.1, 1.1}}, SourceLocation{"scene.yaml", 9, 5, "mesh.groups[0]"}}};
  return spec;
}

TEST(GmshMesh, GroupsAreChosenFromTheOutlineOfARegion)
{
  for (const std::string of : {"soil:boundary", "air:boundary"}) {
    const Mesh<2> mesh = load_mesh<2>(surface_of(of), ".");
    const auto facets = mesh.facet_set("surface");
    Real width = 0;
    for (const Facet f : facets.value()) {
      for (const Index n : mesh.nodes_of(f))
        EXPECT_NEAR(mesh.node(n)[1], 1, round_off);
      width += mesh.area_vector(f).norm();
    }
    EXPECT_NEAR(width, 2, 2 * round_off);
  }
}

TEST(GmshMesh, GroupsAreChosenFromEarlierGroups)
{
  MeshSpec spec = surface_of("soil:boundary");
  spec.groups.push_back({"half", "surface", Box{{0.9, 0}, {3, 3}}, SourceLocation{}});
  const Mesh<2> mesh = load_mesh<2>(spec, ".");
  EXPECT_EQ(2 * mesh.facet_set("half").value().size(), mesh.facet_set("surface").value().size());
}

TEST(GmshMesh, GroupsOfUnknownGroupsAreRefusedAtTheirPlace)
{
  EXPECT_EQ(complaint<2>(surface_of("soil:boundar")),
            "scene.yaml:9:5: error: mesh.groups[0]: of: the mesh has no facet group \"soil:boundar\" — did you mean \"soil:boundary\"?\n"
            "1 error, nothing was run.");
  EXPECT_THAT(complaint<2>(surface_of("surface")), HasSubstr("of: the mesh has no facet group \"surface\"")) << "itself";
  EXPECT_THAT(complaint<2>(surface_of("soil")), HasSubstr("of: the mesh has no facet group \"soil\"")) << "a group of cells";
  EXPECT_THAT(complaint<2>(surface_of("boundary")), HasSubstr("group \"surface\": no facet of \"boundary\" has all its corners"))
      << "the surface is inside the mesh";
}

TEST(GmshMesh, WrongGroupsAreRefusedAtTheirPlace)
{
  const auto said = [](const std::string& name, const Box& within) {
    MeshSpec spec = grid();
    spec.groups = {{name, "boundary", within, SourceLocation{"scene.yaml", 9, 5, "mesh.groups[0]"}}};
    return complaint<2>(spec);
  };
  EXPECT_EQ(said("top", Box{{0, 3}, {1, 4}}),
            "scene.yaml:9:5: error: mesh.groups[0]: group \"top\": no facet of \"boundary\" has all its corners between (0, 3) and (1, "
            "4); the mesh goes from (0, 0) to (2, 1)\n1 error, nothing was run.");
  EXPECT_THAT(said("top", Box{{0, 1, 0}, {1, 1}}), HasSubstr("within.low of group \"top\" has 3 numbers; the scene has dimension 2"));
  EXPECT_THAT(said("top", Box{{0, 2}, {1, 1}}), HasSubstr("within.low (0, 2) is not below within.high (1, 1)"));
  EXPECT_THAT(said("x_min", Box{{0, 0}, {2, 1}}), HasSubstr("the mesh has a facet group \"x_min\" already"));
}

TEST(GmshMesh, WrongRegionsAreRefusedAtTheirPlace)
{
  const auto said = [](Shape shape) { return complaint<2>(regions(0.1, {region("r", std::move(shape))})); };
  EXPECT_THAT(said(Box{{0, 0}, {0, 1}}), HasSubstr("scene.yaml:5:9: error: mesh.regions: region \"r\": low is not below high"));
  EXPECT_THAT(said(Box{{0, 0, 0}, {1, 1}}), HasSubstr("low has 3 numbers; the scene has dimension 2"));
  EXPECT_THAT(said(Cylinder{{0, 0}, {0, 1}, 1}), HasSubstr("a cylinder needs a scene of dimension 3"));
  EXPECT_THAT(said(Polygon{{{0, 0}, {1, 0}}, {}}), HasSubstr("three points or more"));
  EXPECT_THAT(said(Polygon{{{0, 0}, {1, 1}, {1, 0}, {0, 1}}, {}}), HasSubstr("crosses itself: its sides 1 and 3 meet"));
  EXPECT_THAT(said(Polygon{{{0, 0}, {0, 0}, {1, 0}, {0, 1}}, {}}), HasSubstr("stands twice in a row"));
  EXPECT_THAT(complaint<3>(regions(0.1, {region("r", Polygon{{{0, 0}, {1, 0}, {0, 1}}, {}})})), HasSubstr("needs extrude"));
  EXPECT_THAT(complaint<2>(regions(0.1, {region("a", Box{{0, 0}, {1, 1}}), region("b", Box{{0.2, 0.2}, {0.4, 0.4}})})),
              HasSubstr("nothing is left of region \"b\": earlier regions cover it"));
  EXPECT_THAT(complaint<2>(regions(0.1, {region("a", Box{{0, 0}, {1, 1}}), region("a", Box{{1, 0}, {2, 1}})})),
              HasSubstr("two regions have the name \"a\""));
  EXPECT_THAT(complaint<2>(regions(1e-6, {region("a", Box{{0, 0}, {1, 1}})})), HasSubstr("asks for 2.3e+12 cells, more than 1e+08"));
  MeshSpec no_size = regions(1, {region("a", Box{{0, 0}, {1, 1}})});
  no_size.size.reset();
  EXPECT_THAT(complaint<2>(no_size), HasSubstr("scene.yaml:3:7: error: mesh: the mesh needs a size"));
}

TEST(GmshMesh, SidesOfAPolygonMayLieInOneLine)
{
  const Polygon notched{{{0, 0}, {1, 0}, {1.5, 1}, {2, 0}, {3, 0}, {3, 2}, {0, 2}}, {}};
  EXPECT_NEAR(volume_of(load_mesh<2>(regions(0.5, {region("r", notched)}), "."), "r"), 3 * 2 - 0.5, round_off);
  const Polygon folded{{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 0}, {0.5, 0}, {0.5, 1}}, {}};
  EXPECT_THAT(complaint<2>(regions(0.5, {region("r", folded)})), HasSubstr("crosses itself"));
}

class GmshGeometry : public ::testing::Test {
 protected:
  MeshSpec geo(const std::string& text) const
  {
    std::ofstream(folder_ / "a.geo") << text;
    MeshSpec spec;
    spec.where = place_of_mesh;
    spec.geometry = "a.geo";
    return spec;
  }
  const std::string square_ =
      "Point(1) = {0, 0, 0, 0.2};\nPoint(2) = {1, 0, 0, 0.2};\nPoint(3) = {1, 1, 0, 0.2};\nPoint(4) = {0, 1, 0, 0.2};\n"
      "Line(1) = {1, 2};\nLine(2) = {2, 3};\nLine(3) = {3, 4};\nLine(4) = {4, 1};\nCurve Loop(1) = {1, 2, 3, 4};\nPlane Surface(1) = {1};\n"
      "Physical Surface(\"soil\") = {1};\nPhysical Curve(\"floor\") = {1};\n";
  ScratchFolder folder_;
};

TEST_F(GmshGeometry, GeoIsMeshedWithItsGroups)
{
  const Mesh<2> mesh = load_mesh<2>(geo(square_), folder_.path());
  EXPECT_NEAR(volume_of(mesh, "soil"), 1, round_off);
  EXPECT_EQ(mesh.facet_set("floor").value().size(), 5U);
  EXPECT_EQ(mesh.facet_set("floor"), mesh.facet_set("y_min"));
}

TEST_F(GmshGeometry, SizeIsAnUpperBound)
{
  MeshSpec spec = geo(square_);
  spec.size = 0.1;
  EXPECT_EQ(load_mesh<2>(spec, folder_.path()).facet_set("floor").value().size(), 10U);
  spec.size = 5;
  EXPECT_EQ(load_mesh<2>(spec, folder_.path()).facet_set("floor").value().size(), 5U);
}

TEST_F(GmshGeometry, GeoWithoutCellsOfTheDimensionIsRefused)
{
  EXPECT_THAT(complaint<3>(geo(square_), folder_.path()), HasSubstr("error: mesh: the mesh has no tetrahedra"));
  EXPECT_THAT(complaint<2>(geo(""), folder_.path()), HasSubstr("error: mesh: the mesh has no nodes"));
}

TEST_F(GmshGeometry, QuadrilateralsAreRefused)
{
  EXPECT_THAT(complaint<2>(geo(square_ + "Recombine Surface {1};\n"), folder_.path()), HasSubstr("quadrilaterals are not supported"));
}

TEST_F(GmshGeometry, MissingGeometryIsRefused)
{
  MeshSpec missing = geo("");
  missing.geometry = "b.geo";
  EXPECT_THAT(complaint<2>(missing, folder_.path()), HasSubstr("b.geo\" does not exist"));
  missing.geometry = ".";
  EXPECT_THAT(complaint<2>(missing, folder_.path()), HasSubstr("is a folder"));
}

TEST_F(GmshGeometry, MeshErrorsOfFilesNameTheFile)
{
  std::ofstream(folder_ / "a.msh")
      << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 2 -1 0\n$EndNodes\n"
         "$Elements\n3\n1 2 0 1 2 3\n2 2 0 1 2 4\n3 2 0 2 1 5\n$EndElements\n";
  MeshSpec spec;
  spec.where = place_of_mesh;
  spec.file = "a.msh";
  EXPECT_THAT(complaint<2>(spec, folder_.path()), HasSubstr("scene.yaml:3:7: error: mesh: mesh file \"a.msh\": "));
}

TEST_F(GmshGeometry, SolidsOfAStepFileInMillimetresShareFacesInMetres)
{
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::model::occ::addBox(0, 0, 0, 1000, 1000, 1000);
  gmsh::model::occ::addBox(1000, 0, 0, 1000, 1000, 1000);
  gmsh::model::occ::synchronize();
  gmsh::write((folder_ / "two.step").string());
  gmsh::finalize();
  MeshSpec spec;
  spec.where = place_of_mesh;
  spec.geometry = "two.step";
  spec.size = 0.5;
  const Mesh<3> mesh = load_mesh<3>(spec, folder_.path());
  EXPECT_THAT(mesh.cell_set_names(), UnorderedElementsAre("part_1", "part_2"));
  EXPECT_NEAR(volume_of(mesh, "part_1"), 1, round_off);
  EXPECT_NEAR(volume_of(mesh, "part_2"), 1, round_off);
  EXPECT_NEAR(mesh.high()[0], 2, 2 * round_off);
  const auto hull = mesh.facet_set("boundary");
  Real area = 0;
  for (const Facet f : hull.value())
    area += mesh.area_vector(f).norm();
  EXPECT_NEAR(area, 10, 10 * round_off) << "12 if the faces between them were not shared";
}

/// Last of all: the parser of gmsh 4.8 does not recover from a syntax error within a process.
TEST_F(GmshGeometry, SyntaxErrorIsRefusedWithTheWordsOfGmsh)
{
  const std::string said = complaint<2>(geo("Point(1) = {0, 0 0};\n"), folder_.path());
  EXPECT_THAT(said, HasSubstr("scene.yaml:3:7: error: mesh: gmsh cannot make this mesh: opening"));
  EXPECT_THAT(said, HasSubstr("line 1"));
}

}  // namespace
}  // namespace talus::gmsh_mesh_test
