// Outlines from files, brought to the map.
#include "tests/io/terrain/surface_files.hpp"

namespace talus::surface_file_test {
namespace {

using OutlineFile = SurfaceFile;

TEST_F(OutlineFile, OutlinesInDegreesAreBroughtToTheMap)
{
  plan.crs = "EPSG:32633";
  write_whole(folder / "dam.geojson",
              R"({"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {"name": "dam"}, "geometry":
    {"type": "Polygon", "coordinates": [[[15, 0], [15.001, 0], [15.001, 0.001], [15, 0]]]}}]})");
  const auto polygons = read_outlines("dam.geojson", {"slope.yaml", 1, 1, "outline_file"}, plan, problems, repairs);
  ASSERT_EQ(polygons.size(), 1U);
  EXPECT_EQ(polygons[0].name, "dam");
  ASSERT_EQ(polygons[0].outer.size(), 3U);
  EXPECT_NEAR(polygons[0].outer[0][0], 500000, 1e-3);
  EXPECT_NEAR(polygons[0].outer[1][0], 500000 + 111.3, 0.1);  // 0.001 degrees on the equator, times 0.9996
  EXPECT_THAT(only_repair(), HasSubstr("brought from WGS 84"));
}

TEST_F(OutlineFile, GeojsonInMetresIsTakenForTheMapAndThatIsTold)
{
  plan.crs = "EPSG:32633";
  write_whole(folder / "dam.geojson",
              R"({"type": "Polygon", "coordinates": [[[512000, 5180000], [512010, 5180000], [512010, 5180010], [512000, 5180000]]]})");
  const auto polygons = read_outlines("dam.geojson", {}, plan, problems, repairs);
  ASSERT_EQ(polygons.size(), 1U);
  EXPECT_THAT(polygons[0].outer, ElementsAre(ElementsAre(512000, 5180000), ElementsAre(512010, 5180000), ElementsAre(512010, 5180010)));
  EXPECT_THAT(only_repair(), HasSubstr("its numbers are no degrees"));
}

TEST_F(OutlineFile, OutlinesAsTextInATableHaveTheirHoles)
{
  write_whole(folder / "areas.csv",
              "name,WKT\nyard,\"POLYGON ((0 0,9 0,9 9,0 0),(5 1,6 1,6 2,5 1))\"\npair,\"MULTIPOLYGON (((0 0,1 0,1 1,0 0)),((5 5,6 5,6 6,5 "
              "5)))\"\n");
  const auto polygons = read_outlines("areas.csv", {}, plan, problems, repairs);
  ASSERT_EQ(polygons.size(), 3U);
  EXPECT_EQ(polygons[0].name, "yard");
  EXPECT_EQ(polygons[0].holes.size(), 1U);
  EXPECT_EQ(polygons[2].name, "pair");
}

TEST_F(OutlineFile, FileWithoutOutlinesIsAProblemOfTheScene)
{
  write_whole(folder / "point.geojson", R"({"type": "Point", "coordinates": [1, 2]})");
  const SourceLocation where{"slope.yaml", 4, 5, "mesh.terrain.domain_file"};
  EXPECT_THAT(read_outlines("point.geojson", where, plan, problems, repairs), IsEmpty());
  EXPECT_THAT(only_problem(), AllOf(HasSubstr("slope.yaml:4:5"), HasSubstr("has no polygon")));
  problems.clear();
  EXPECT_THAT(read_outlines("missing.shp", where, plan, problems, repairs), IsEmpty());
  EXPECT_THAT(only_problem(), HasSubstr("there is no such file"));
}

}  // namespace
}  // namespace talus::surface_file_test
