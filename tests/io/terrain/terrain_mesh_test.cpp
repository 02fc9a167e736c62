// Meshes of terrain: volumes, groups, repairs that are told, and what cannot be.
#include "io/terrain/terrain_mesh.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "io/scene/reader.hpp"
#include "tests/io/mesh/mesh_measures.hpp"

namespace talus::terrain_mesh_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

const std::string rest = R"(
materials: [{name: rock, law: linear_elastic, density: 2000, youngs_modulus: 1.0e6, poisson_ratio: 0.3}]
bodies: [{name: all, material: rock, region: air}]
time: {end: 1}
)";

/// A scene whose block `mesh` is this text, indented by two.
Scene scene(int dimension, const std::string& mesh)
{
  return read_scene_text("scene.yaml", "title: t\ndimension: " + std::to_string(dimension) + "\nmesh:\n" + mesh + rest);
}

template <int D>
Mesh<D> mesh_of(const std::string& block)
{
  Scene asked = scene(D, block);
  return load_mesh<D>(asked.mesh, ".");
}

template <int D>
std::string complaint_of(const std::string& block)
{
  try {
    return complaint<D>(scene(D, block).mesh);
  } catch (const SceneErrors& errors) {  // of the reader
    return errors.what();
  }
}

const std::string slope = R"(
  size: 0.5
  terrain:
    ground: {points: [[0, 10], [8, 10], [14, 6], [30, 6]]}
)";

TEST(TerrainMesh, LayersHoldWhatLiesBetweenLinesThroughPoints)
{
  const Mesh<2> mesh = mesh_of<2>(slope + R"(
    layers:
      - {name: soil, bottom: {depth: 2}}
      - {name: rock, bottom: {elevation: 0}, size: 1}
    air: {height: 3}
)");
  EXPECT_NEAR(volume_of(mesh, "layer:soil"), 30 * 2, 1e-10);
  EXPECT_NEAR(volume_of(mesh, "layer:rock"), 8 * 8 + 6 * 6 + 16 * 4, 1e-10);
  EXPECT_NEAR(volume_of(mesh, "air"), 30 * 3, 1e-10);
  EXPECT_NEAR(area_of(mesh, "base"), 30, 1e-10);
  const Real ground = 8 + std::hypot(6, 4) + 16;
  EXPECT_NEAR(area_of(mesh, "terrain"), ground, 1e-10);
  EXPECT_NEAR(area_of(mesh, "top"), ground, 1e-10);
  EXPECT_NEAR(area_of(mesh, "layer:soil:bottom"), ground, 1e-10);
  EXPECT_NEAR(area_of(mesh, "sides"), 13 + 9, 1e-10);
  EXPECT_FALSE(mesh.map());  // x is x
  EXPECT_THAT(mesh.notes(), IsEmpty());
}

TEST(TerrainMesh, WithoutLayersTheGroundIsTheBottomOfTheAir)
{
  const Mesh<2> mesh = mesh_of<2>(slope + "    air: {height: 3}\n");
  EXPECT_THAT(mesh.cell_set_names(), ElementsAre("air"));
  EXPECT_EQ(mesh.facet_set("base"), mesh.facet_set("terrain"));
  EXPECT_NEAR(area_of(mesh, "base"), 8 + std::hypot(6, 4) + 16, 1e-10);
}

/// A plane that falls by half along x, and a slip surface that is a tenth of a metre above it but for a wedge.
const std::string hill = R"(
  size: 2
  terrain:
    ground: {points: [[512000, 5180000, 40], [512060, 5180000, 10], [512000, 5180030, 40], [512060, 5180030, 10]]}
    domain: [[512000, 5180000], [512060, 5180030]]
    origin: [512000, 5180000]
    crs: EPSG:32633
)";

TEST(TerrainMesh, LiesOnTheMap)
{
  const Mesh<3> mesh = mesh_of<3>(hill + "    layers: [{name: rock, bottom: {elevation: 0}}]\n");
  ASSERT_TRUE(mesh.map());
  EXPECT_EQ(mesh.map()->crs, "EPSG:32633");
  EXPECT_THAT(mesh.map()->to_map(3, 4), ElementsAre(512003, 5180004));
  EXPECT_NEAR(volume_of(mesh, "layer:rock"), 60 * 30 * 25, 1e-6);
  EXPECT_NEAR(area_of(mesh, "terrain"), 30 * std::hypot(60, 30), 1e-6);
  EXPECT_FALSE(mesh.facet_set("top"));
  EXPECT_THAT(terrain_in_words(mesh, "  "), HasSubstr("  on the map from (512000, 5180000) to (512060, 5180030), EPSG:32633"));
  EXPECT_THAT(terrain_in_words(mesh, ""), HasSubstr("layer:rock: 4.5e+04 m3"));
}

TEST(TerrainMesh, ASectionGoesAlongALineOfTheMap)
{
  Scene asked = scene(2, R"(
  size: 1
  terrain:
    ground: {points: [[512000, 5180000, 40], [512060, 5180000, 10], [512000, 5180030, 40], [512060, 5180030, 10]]}
    section: {from: [512010, 5180002], to: [512050, 5180027]}
    layers: [{name: rock, bottom: {depth: 5}}]
)");
  const Mesh<2> mesh = load_mesh<2>(asked.mesh, ".");
  const Real length = std::hypot(40, 25);
  EXPECT_NEAR(mesh.high()[0], length, 1e-9);
  EXPECT_NEAR(volume_of(mesh, "layer:rock"), 5 * length, 1e-9);
  EXPECT_NEAR(mesh.high()[1], 35, 1e-9);
  ASSERT_TRUE(mesh.map());
  const auto end = mesh.map()->to_map(length);
  EXPECT_NEAR(end[0], 512050, 1e-6);
  EXPECT_NEAR(end[1], 5180027, 1e-6);
}

TEST(TerrainMesh, AirReachesAsFarAsTheLineFalls)
{
  // From the crest at x = 8 a line of 30 degrees is as high as the plain, 4 m below, after 6.93 m: beyond, no air.
  const Mesh<2> mesh = mesh_of<2>(slope + R"(
    layers: [{name: slide, bottom: {points: [[0, 10], [5, 10], [6, 9], [8, 9.4], [8.5, 9.66666667], [30, 6]]}}]
    air: {height: 3, reach: 30}
)");
  Real farthest = 0;
  const auto cells = mesh.cell_set("air");
  for (const Index c : cells.value())
    for (const Index n : mesh.cell(c))
      farthest = std::max(farthest, mesh.node(n)[0]);
  EXPECT_NEAR(farthest, 8.5 + (10 - 1.0 / 3 - 6) / std::tan(std::numbers::pi / 6), 0.7);
}

TEST(TerrainMesh, ObstaclesAreLeftOut)
{
  const std::string dam = R"(
    air: {height: 6}
    obstacles: [{name: dam, outline: [[512040.5, 5180004.25], [512044.75, 5180021.5]], height: 3}]
)";
  const Mesh<3> mesh = mesh_of<3>(hill + dam);
  EXPECT_NEAR(volume_of(mesh, "air"), (60 * 30 * 6) - 4.25 * 17.25 * 3, 1e-6);
  const Real slant = std::hypot(1, 0.5);
  EXPECT_NEAR(area_of(mesh, "obstacle:dam"), 4.25 * 17.25 * slant + 3 * 2 * (4.25 + 17.25), 1e-6);
  EXPECT_NEAR(area_of(mesh, "base"), (60 * 30 - 4.25 * 17.25) * slant, 1e-6);
  const Mesh<2> line = mesh_of<2>(slope + "    air: {height: 3}\n    obstacles: [{name: wall, outline: [[20.1], [20.9]], height: 1.3}]\n");
  EXPECT_NEAR(volume_of(line, "air"), 30 * 3 - 0.8 * 1.3, 1e-10);
  EXPECT_NEAR(area_of(line, "obstacle:wall"), 0.8 + 2 * 1.3, 1e-10);
}

TEST(TerrainMesh, OutlinesMayBeFarLargerThanWhatIsMeshed)
{
  const auto mesh_within = [](const std::string& corners) {
    return mesh_of<3>(hill + "    layers: [{name: fill, bottom: {depth: 3}, within: " + corners + "}]\n    air: {height: 4}\n");
  };
  // A country, of which the domain is a small part: the same as without an outline.
  const Mesh<3> all = mesh_within("[[-1.0e+6, 4.0e+6], [2.0e+6, 6.0e+6]]");
  EXPECT_NEAR(volume_of(all, "layer:fill"), 60 * 30 * 3, 1e-6);
  EXPECT_EQ(all.n_cells(), mesh_of<3>(hill + "    layers: [{name: fill, bottom: {depth: 3}}]\n    air: {height: 4}\n").n_cells());
  // Its border crosses the domain from (512020, 5180000) to (512040, 5180030).
  const Mesh<3> half = mesh_within("[[512020, 5180000], [1.0e+6, 5.0e+6], [1.0e+6, 6.0e+6], [512040, 5180030]]");
  EXPECT_NEAR(volume_of(half, "layer:fill"), 30 * 30 * 3, 1e-6);
  EXPECT_LT(half.n_cells(), 2 * all.n_cells());
  EXPECT_THAT(complaint_of<3>(hill + "    layers: [{name: fill, bottom: {depth: 3}, within: [[520000, 5180000], [600000, 5280000]]}]\n"),
              HasSubstr("layer \"fill\" has no part within what is meshed"));
}

TEST(TerrainMesh, OutsideOfItsAreaALayerIsTheNextOne)
{
  const Mesh<3> mesh = mesh_of<3>(hill + R"(
    layers:
      - {name: fill, bottom: {depth: 3}, within: [[512010, 5180010], [512030, 5180010], [512020, 5180020]]}
      - {name: rock, bottom: {elevation: 0}}
)");
  EXPECT_NEAR(volume_of(mesh, "layer:fill"), 100 * 3, 1e-6);
  EXPECT_NEAR(volume_of(mesh, "layer:rock"), 60 * 30 * 25 - 300, 1e-6);
  EXPECT_NEAR(area_of(mesh, "layer:fill:bottom"), 100 * std::hypot(1, 0.5), 1e-6);
}

TEST(TerrainMesh, OutlinesOfManyCornersDoNotMakeSmallCells)
{
  std::string corners;
  constexpr int n = 300;
  for (int i = 0; i < n; ++i) {
    const Real angle = 2 * std::numbers::pi * i / n;
    corners += (i > 0 ? ", " : "") + std::string("[") + std::to_string(512030 + 8 * std::cos(angle)) + ", " +
               std::to_string(5180015 + 8 * std::sin(angle)) + "]";
  }
  const Mesh<3> mesh =
      mesh_of<3>(hill + "    layers: [{name: fill, bottom: {depth: 3}, within: [" + corners + "]}]\n    air: {height: 4}\n");
  EXPECT_LT(mesh.n_cells(), 1.5 * 7 * (60 * 30 * 4) / (2 * 2 * 2));
  EXPECT_NEAR(volume_of(mesh, "layer:fill"), 3 * std::numbers::pi * 64, 0.03 * 3 * std::numbers::pi * 64);
}

TEST(TerrainMesh, CellsAreFinerAlongALine)
{
  const Mesh<3> mesh = mesh_of<3>(hill + R"(
    air: {height: 2, size: 2}
    refine: [{along: [[512000, 5180015], [512060, 5180015]], width: 6, size: 1}]
)");
  const auto edges_at = [&](Real y) {
    Real sum = 0;
    int count = 0;
    for (Index n = 0; n < mesh.n_nodes(); ++n)
      if (std::abs(mesh.node(n)[1] - y) < 3) {
        sum += mesh.node_size(n);
        ++count;
      }
    return sum / count;
  };
  EXPECT_LT(edges_at(15), 0.7 * edges_at(2));
}

TEST(TerrainMesh, AccuracyScalesSizes)
{
  const std::string block = slope + "    layers: [{name: rock, bottom: {elevation: 0}, size: 1}]\n";
  const Scene draft = read_scene_text("scene.yaml", "title: t\ndimension: 2\naccuracy: draft\nmesh:" + block + rest);
  EXPECT_EQ(draft.mesh.size, 1);
  EXPECT_EQ(draft.mesh.terrain->layers[0].size, 2);
}

TEST(TerrainMesh, TellsWhatItMends)
{
  const Mesh<2> mesh = mesh_of<2>(slope + R"(
    layers:
      - {name: slide, bottom: {points: [[0, 11], [2, 11], [5, 8], [14, 5.9], [15, 5.9], [16, 5.9], [20, 6.2]]}}
      - {name: rock, bottom: {elevation: 0}}
)");
  ASSERT_EQ(mesh.notes().size(), 3u);
  EXPECT_THAT(mesh.notes()[0], HasSubstr("layer \"slide\" has no thickness where its bottom is not known, over"));
  EXPECT_THAT(mesh.notes()[1], HasSubstr("layer \"slide\" has no thickness where its bottom lies above the ground"));
  EXPECT_THAT(mesh.notes()[1], HasSubstr("by 1 m at most"));
  EXPECT_THAT(mesh.notes()[2], HasSubstr("was closed where it is thinner than a quarter of a cell"));
}

TEST(TerrainMesh, SaysAtOnceWhatCannotBe)
{
  const std::string all = complaint_of<3>(hill + R"(
    layers:
      - {name: slide, bottom: {elevation: 41}}
      - {name: fill, bottom: {elevation: 0}, within: [[512100, 5180010], [512130, 5180010], [512120, 5180020]]}
)");
  EXPECT_THAT(all, HasSubstr("scene.yaml:13:31: error: mesh.terrain.layers[0] \"slide\".bottom: "));
  EXPECT_THAT(all, HasSubstr("layer \"slide\" has no thickness anywhere"));
  EXPECT_THAT(all, HasSubstr("its bottom is above the ground (by 31 m at most) over 1800 m2"));
  EXPECT_THAT(all, HasSubstr("layer \"fill\" has no part within what is meshed, 512000 to 512060 east, 5180000 to 5180030 north"));
  const std::string bad_outlines = complaint_of<3>(hill + R"(
    air: {height: 5}
    obstacles:
      - {name: bow, outline: [[512010, 5180010], [512020, 5180020], [512020, 5180010], [512010, 5180020]], height: 3}
      - {name: line, outline: [[512010, 5180010], [512010, 5180020]], height: 3}
)");
  EXPECT_THAT(bad_outlines, HasSubstr("outline crosses itself at (512015, 5180015)"));
  EXPECT_THAT(bad_outlines, HasSubstr("the two corners of outline span no rectangle"));
  const std::string far = complaint_of<3>(hill + R"(
    air: {height: 5}
    obstacles: [{name: dam, outline: [[512100, 5180010], [512110, 5180020]], height: 3}]
)");
  EXPECT_THAT(far, HasSubstr("obstacle \"dam\" lies outside what is meshed"));
  EXPECT_THAT(complaint_of<2>(slope + "    domain: [[-5], [20]]\n    air: {height: 1}\n"),
              HasSubstr("the ground is not known at 10 of 51 places"));
  EXPECT_THAT(complaint_of<2>(slope + "    domain_file: area.geojson\n    air: {height: 1}\n"), HasSubstr("domain_file is for the map"));
}

TEST(TerrainMesh, ObstaclesBeyondTheLineOfReachAreRefused)
{
  EXPECT_THAT(complaint_of<2>(slope + R"(
    layers: [{name: slide, bottom: {points: [[0, 10], [5, 10], [6, 9], [8, 9.4], [8.5, 9.66666667], [30, 6]]}}]
    air: {height: 3, reach: 30}
    obstacles: [{name: wall, outline: [[20.1], [20.9]], height: 1.3}]
)"),
              HasSubstr("obstacle \"wall\" stands where there is no air"));
}

TEST(TerrainMesh, EqualScenesGiveEqualBits)
{
  const std::string block = hill + R"(
    air: {height: 4}
    layers: [{name: fill, bottom: {depth: 3}, within: [[512010, 5180010], [512030, 5180010], [512020, 5180020]]}]
    refine: [{down_from: fill, width: 6, size: 1.5}]
)";
  const Mesh<3> first = mesh_of<3>(block), second = mesh_of<3>(block);
  EXPECT_TRUE(std::equal(first.nodes().begin(), first.nodes().end(), second.nodes().begin(), second.nodes().end()));
  EXPECT_TRUE(std::equal(first.cells().begin(), first.cells().end(), second.cells().begin(), second.cells().end()));
}

}  // namespace
}  // namespace talus::terrain_mesh_test
