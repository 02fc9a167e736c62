// Surfaces and outlines of a scene, read from files; what is wrong with them and what is mended.
#include "io/terrain/surface_file.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "io/files/atomic_file.hpp"
#include "io/terrain/point_file.hpp"
#include "io/terrain/raster_file.hpp"
#include "tests/io/scratch_folder.hpp"

namespace talus::surface_file_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr Real nan = std::numeric_limits<Real>::quiet_NaN();
constexpr Real east = 512000, north = 5180000;

/// A plane over the map, 12 cells of 5 m by 10.
Real plane(Real x, Real y) { return 700 + 0.5 * (x - east) - 0.25 * (y - north); }
Raster sloping()
{
  Raster raster;
  raster.columns = 12;
  raster.rows = 10;
  raster.west = east;
  raster.south = north;
  raster.dx = raster.dy = 5;
  raster.crs = "EPSG:32633";
  for (Index r = 0; r < raster.rows; ++r)
    for (Index c = 0; c < raster.columns; ++c)
      raster.values.push_back(plane(east + 5 * (c + 0.5), north + 5 * (r + 0.5)));
  return raster;
}

class SurfaceFile : public testing::Test {
 protected:
  std::optional<SurfaceRead> read(const SurfaceSpec& spec) { return read_surface(spec, plan, problems, repairs); }
  std::optional<SurfaceRead> read(const std::string& file)
  {
    SurfaceSpec spec;
    spec.file = file;
    spec.where = {"slope.yaml", 7, 3, "mesh.terrain.ground"};
    return read(spec);
  }
  std::optional<SurfaceRead> read_points_of_scene(std::vector<std::vector<Real>> points)
  {
    SurfaceSpec spec;
    spec.points = std::move(points);
    return read(spec);
  }
  std::string only_problem() const
  {
    EXPECT_EQ(problems.size(), 1U);
    return problems.empty() ? "" : to_string(problems[0].where) + ": " + problems[0].message;
  }
  std::string only_repair() const
  {
    EXPECT_EQ(repairs.size(), 1U);
    return repairs.empty() ? "" : repairs[0];
  }
  void expect_plane(const SurfaceRead& surface, Real tolerance = 1e-9) const
  {
    for (Real x = east + 3; x < east + 57; x += 2.7)
      for (Real y = north + 3; y < north + 47; y += 3.1)
        EXPECT_NEAR(surface.at({x, y}), plane(x, y), tolerance) << x << ' ' << y;
  }

  ScratchFolder folder;
  MapPlan plan{folder.path(), "", false, {}};
  std::vector<SceneError> problems;
  std::vector<std::string> repairs;
};

TEST_F(SurfaceFile, RasterIsBilinearUpToItsEdgeAndKnowsItsMap)
{
  write_raster(folder / "ground.tif", sloping());
  const auto ground = read("ground.tif");
  ASSERT_TRUE(ground);
  expect_plane(*ground);
  EXPECT_NEAR(ground->at({east, north}), plane(east, north), 1e-9);
  EXPECT_NEAR(ground->at({east + 60, north + 50}), plane(east + 60, north + 50), 1e-9);
  EXPECT_TRUE(std::isnan(ground->at({east - 0.1, north})));
  EXPECT_EQ(plan.crs, "EPSG:32633");
  EXPECT_EQ(ground->extent->east, east + 60);
  EXPECT_EQ(ground->spacing, 5);
  EXPECT_THAT(repairs, IsEmpty());
}

TEST_F(SurfaceFile, DegreesAreRefusedWithTheCommandThatReprojects)
{
  Raster raster = sloping();
  raster.west = 15.1;
  raster.south = 46.7;
  raster.dx = raster.dy = 1e-4;
  raster.crs = "EPSG:4326";
  write_raster(folder / "ground.tif", raster);
  EXPECT_FALSE(read("ground.tif"));
  EXPECT_THAT(only_problem(), AllOf(HasSubstr("slope.yaml:7:3"), HasSubstr("ground.tif: places are in degrees"), HasSubstr("UTM zone 33N"),
                                    HasSubstr("gdalwarp -t_srs EPSG:32633 -r bilinear ground.tif ground_on_the_map.tif")));
}

TEST_F(SurfaceFile, FeetOverThePlanAreRefused)
{
  Raster raster = sloping();
  raster.west = 980000;
  raster.south = 190000;
  raster.crs = "EPSG:2263";  // New York Long Island, US survey feet
  write_raster(folder / "ground.tif", raster);
  EXPECT_FALSE(read("ground.tif"));
  EXPECT_THAT(only_problem(), AllOf(HasSubstr("US survey foot"), HasSubstr("EPSG:32618")));
}

TEST_F(SurfaceFile, FeetOfElevationBecomeMetresAndThatIsTold)
{
  Raster raster = sloping();
  for (Real& z : raster.values)
    z /= 0.3048;
  raster.unit = "ft";
  write_raster(folder / "ground.tif", raster);
  const auto ground = read("ground.tif");
  ASSERT_TRUE(ground);
  expect_plane(*ground, 1e-3);  // float32
  EXPECT_THAT(only_repair(), AllOf(HasSubstr("slope.yaml:7:3"), HasSubstr("elevations were in ft and are multiplied by 0.3048")));
}

TEST_F(SurfaceFile, UnknownUnitIsRefused)
{
  Raster raster = sloping();
  raster.unit = "furlong";
  write_raster(folder / "ground.tif", raster);
  EXPECT_FALSE(read("ground.tif"));
  EXPECT_THAT(only_problem(), HasSubstr("'furlong'"));
}

TEST_F(SurfaceFile, TwoCoordinateSystemsAreRefused)
{
  write_raster(folder / "ground.tif", sloping());
  Raster other = sloping();
  other.crs = "EPSG:32632";
  write_raster(folder / "slip.tif", other);
  EXPECT_TRUE(read("ground.tif"));
  EXPECT_FALSE(read("slip.tif"));
  EXPECT_THAT(only_problem(), AllOf(HasSubstr("UTM zone 32N"), HasSubstr("that of the map is WGS 84 / UTM zone 33N"),
                                    HasSubstr("gdalwarp -t_srs EPSG:32633")));
}

TEST_F(SurfaceFile, RasterWithoutCoordinateSystemIsTakenForTheMapAndThatIsTold)
{
  Raster raster = sloping();
  raster.crs.clear();
  write_raster(folder / "ground.asc", raster);
  EXPECT_TRUE(read("ground.asc"));
  EXPECT_THAT(only_repair(), HasSubstr("taken for metres"));
  repairs.clear();
  plan.crs = "EPSG:32633";
  EXPECT_TRUE(read("ground.asc"));
  EXPECT_THAT(only_repair(), HasSubstr("in that of the map, EPSG:32633"));
}

TEST_F(SurfaceFile, SmallHoleIsFilledAndThatIsTold)
{
  Raster raster = sloping();
  raster.at(4, 4) = raster.at(5, 4) = raster.at(5, 5) = nan;
  write_raster(folder / "ground.tif", raster);
  const auto ground = read("ground.tif");
  ASSERT_TRUE(ground);
  expect_plane(*ground, 1e-4);  // of Laplace's equation a plane is a solution
  EXPECT_THAT(only_repair(),
              HasSubstr("3 cells without a value in 1 hole of up to 2 cells across is filled smoothly from around; the first at "
                        "512020..512030 east, 5180020..5180030 north"));
}

TEST_F(SurfaceFile, LargeHoleIsAnErrorOnlyWhereItIsWanted)
{
  Raster raster = sloping();
  raster.columns = 40;
  raster.rows = 30;
  raster.values.assign(1200, 500);
  for (Index c = 10; c < 25; ++c)
    raster.at(c, 12) = nan;
  write_raster(folder / "ground.tif", raster);
  const auto ground = read("ground.tif");
  ASSERT_TRUE(ground);
  EXPECT_THAT(repairs, IsEmpty());
  const SourceLocation where{"slope.yaml", 7, 3, "mesh.terrain.ground"};
  check_cover(*ground, where, {{east, north}, {east + 40, north}, {east + 40, north + 150}, {east, north + 150}}, "domain", problems);
  EXPECT_THAT(problems, IsEmpty());
  check_cover(*ground, where, {{east, north}, {east + 200, north}, {east + 200, north + 150}, {east, north + 150}}, "domain", problems);
  EXPECT_THAT(only_problem(),
              AllOf(HasSubstr("ground.tif has no value in"),
                    HasSubstr("of the domain, within 512052.5..512122.5 east, 5180062.5..5180062.5 north"), HasSubstr("gdal_fillnodata")));
}

TEST_F(SurfaceFile, DomainBeyondTheRasterIsAnErrorWithBothExtents)
{
  write_raster(folder / "ground.tif", sloping());
  const auto ground = read("ground.tif");
  ASSERT_TRUE(ground);
  check_cover(*ground, {"slope.yaml", 9, 3, "mesh.terrain.domain"},
              {{east, north}, {east + 90, north}, {east + 90, north + 40}, {east, north + 40}}, "domain", problems);
  EXPECT_THAT(only_problem(), AllOf(HasSubstr("slope.yaml:9:3"), HasSubstr("ground.tif covers 512000..512060 east, 5180000..5180050 north"),
                                    HasSubstr("the domain is 512000..512090 east, 5180000..5180040 north: it reaches 30 m beyond")));
}

TEST_F(SurfaceFile, ImplausibleElevationsAreRefused)
{
  const auto with = [&](const std::string& name, Real value) {
    Raster raster = sloping();
    raster.values.assign(raster.values.size(), value);
    write_raster(folder / name, raster);
    EXPECT_FALSE(read(name));
  };
  with("zero.tif", 0);
  with("none.tif", nan);
  with("high.tif", 70000);
  ASSERT_EQ(problems.size(), 3U);
  EXPECT_THAT(problems[0].message, HasSubstr("all elevations are zero"));
  EXPECT_THAT(problems[1].message, HasSubstr("no cell has a value"));
  EXPECT_THAT(problems[2].message, HasSubstr("from 70000 m to 70000 m are not those of any ground"));
}

TEST_F(SurfaceFile, ValueForNoneThatIsNotDeclaredIsDroppedAndThatIsTold)
{
  write_whole(folder / "g.asc", "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\n4 4 4\n4 -32768 4\n4 4 4\n");
  const auto ground = read("g.asc");
  ASSERT_TRUE(ground);
  EXPECT_NEAR(ground->at({1.5, 1.5}), 4, 1e-9);
  ASSERT_EQ(repairs.size(), 3U);
  EXPECT_THAT(repairs[1], HasSubstr("1 cell has the value -32768, which is taken for none"));
}

TEST_F(SurfaceFile, CellsOfNanAreHolesInAWholeNumberedAsciiGridToo)
{
  const std::string whole_row = "100 100 100 100 100\n";
  write_whole(folder / "g.asc", "ncols 5\nnrows 5\nxllcorner 0\nyllcorner 0\ncellsize 1\n" + whole_row + "100 nan 100 100 100\n" +
                                    whole_row + "100 100 100 inf 100\n" + whole_row);
  const auto ground = read("g.asc");
  ASSERT_TRUE(ground);
  EXPECT_NEAR(ground->at({1.5, 3.5}), 100, 1e-9) << "0 would be a pit";
  EXPECT_NEAR(ground->at({3.5, 1.5}), 100, 1e-9);
  EXPECT_THAT(repairs.back(), HasSubstr("2 cells without a value"));
}

TEST_F(SurfaceFile, WordsAmongTheElevationsAreNamedByLineAndColumn)
{
  const std::string head = "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
  write_whole(folder / "g.asc", head + "100 100 100\n100 1O0 hole\n");
  EXPECT_FALSE(read("g.asc"));
  ASSERT_EQ(problems.size(), 2U);
  EXPECT_EQ(to_string(problems[0].where), (folder / "g.asc").string() + ":7:5");
  EXPECT_THAT(problems[0].message, AllOf(HasSubstr("'1O0' is no number"), HasSubstr("slope.yaml:7:3")));
  EXPECT_EQ(to_string(problems[1].where), (folder / "g.asc").string() + ":7:9");
  for (const auto& [text, what] : {std::pair{head + "NODATA_value none\n1 2 3\n4 5 6\n", "nodata_value is 'none', which is no number"},
                                   {head + "1 2 3\n4 5 1.0D+02\n", "'1.0D+02' is no number"},
                                   {head + "nan 2 3\n4 5 6\n", "'nan' begins the first row"}}) {
    problems.clear();
    write_whole(folder / "h.asc", text);
    EXPECT_FALSE(read("h.asc"));
    EXPECT_THAT(only_problem(), HasSubstr(what));
  }
  problems.clear();
  write_whole(folder / "k.asc", head + "1,5 2.5 +3\r\n\r\n1e2 -1.#IND 6 \r\n");
  EXPECT_TRUE(read("k.asc")) << (problems.empty() ? "" : problems[0].message);
}

TEST_F(SurfaceFile, ValuesAfterTheLastRowAreTold)
{
  write_whole(folder / "g.asc", "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n4 5 6\n7 8 9\n");
  const auto ground = read("g.asc");
  ASSERT_TRUE(ground);
  ASSERT_FALSE(repairs.empty());
  EXPECT_THAT(repairs.front(), HasSubstr("g.asc: 3 values after the last row are passed over; the first is '7' in line 8"));
  EXPECT_NEAR(ground->at({0.5, 1.5}), 1, 1e-9);
}

TEST_F(SurfaceFile, DecimalsFarDownInAnAsciiGridAreNotCutOff)
{
  std::string text = "ncols 200\nnrows 1000\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
  for (int row = 0; row < 1000; ++row)
    for (int column = 0; column < 200; ++column)
      text += row == 999 ? "7.75 " : "7 ";
  write_whole(folder / "g.asc", text);
  const auto ground = read("g.asc");
  ASSERT_TRUE(ground);
  EXPECT_NEAR(ground->at({100, 0.5}), 7.75, 1e-9);
}

TEST_F(SurfaceFile, MissingFileIsAProblemOfTheScene)
{
  EXPECT_FALSE(read("missing.tif"));
  EXPECT_THAT(only_problem(), AllOf(HasSubstr("slope.yaml:7:3"), HasSubstr("missing.tif: there is no such file")));
  for (const char* name : {"missing.csv", "missing.stl"}) {
    problems.clear();
    EXPECT_FALSE(read(name));
    EXPECT_THAT(only_problem(), AllOf(HasSubstr("slope.yaml:7:3"), HasSubstr(name)));
  }
}

TEST_F(SurfaceFile, ScatteredPointsAreTriangulated)
{
  std::string text = "east,north,elevation\n# survey of spring\n";
  for (int i = 0; i < 60; ++i) {  // a sequence that fills the square evenly, and its corners
    const Real x = east + 60 * std::fmod(0.754877666 * i, 1), y = north + 50 * std::fmod(0.569840291 * i, 1);
    text += fmt::format("{},{},{}\n", x, y, plane(x, y));
  }
  for (const auto& [x, y] : {std::pair{0, 0}, {60, 0}, {60, 50}, {0, 50}})
    text += fmt::format("{};{}\t{}\n", east + x, north + y, plane(east + x, north + y));
  write_whole(folder / "survey.csv", text);
  const auto ground = read("survey.csv");
  ASSERT_TRUE(ground);
  expect_plane(*ground, 1e-6);
  EXPECT_TRUE(std::isnan(ground->at({east - 1, north + 10})));
}

TEST_F(SurfaceFile, PointsOnAGridAreARaster)
{
  std::string text;
  for (int j = 0; j <= 10; ++j)
    for (int i = 0; i <= 12; ++i)
      if (i != 5 || j != 5)
        text += fmt::format("{} {} {}\n", east + 5 * i, north + 5 * j, plane(east + 5 * i, north + 5 * j));
  write_whole(folder / "ground.xyz", text);
  const auto points = read_points(folder / "ground.xyz");
  const auto raster = as_raster(points);
  ASSERT_TRUE(raster);
  EXPECT_EQ(raster->columns, 13);
  EXPECT_EQ(raster->rows, 11);
  const auto ground = read("ground.xyz");
  ASSERT_TRUE(ground);
  expect_plane(*ground, 1e-6);
  EXPECT_THAT(only_repair(), HasSubstr("1 cell without a value"));
}

TEST_F(SurfaceFile, WrongRowsOfPointsAreNamedByTheirLines)
{
  write_whole(folder / "survey.csv", "x,y,z\n1,2,3\n4,five,6\n7,8\n");
  EXPECT_FALSE(read("survey.csv"));
  ASSERT_EQ(problems.size(), 2U);
  EXPECT_EQ(problems[0].where.line, 3);
  EXPECT_EQ(problems[0].where.column, 3);
  EXPECT_THAT(problems[0].message, AllOf(HasSubstr("'five' is no number"), HasSubstr("slope.yaml:7:3")));
  EXPECT_EQ(problems[1].where.line, 4);
  EXPECT_THAT(problems[1].message, HasSubstr("three numbers"));
}

TEST_F(SurfaceFile, PointsOnALineSpanNothing)
{
  write_whole(folder / "line.csv", "0,0,1\n1,1,2\n2,2,3\n5,5,1\n");
  testing::internal::CaptureStderr();
  EXPECT_FALSE(read("line.csv"));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");  // nor does qhull speak
  EXPECT_THAT(only_problem(), HasSubstr("lie on one line"));
}

TEST_F(SurfaceFile, PointsAtOnePlaceBecomeTheirMeanAndThatIsTold)
{
  const auto surface = read_points_of_scene({{0, 0, 1}, {4, 0, 1}, {0, 4, 1}, {0, 4, 3}});
  ASSERT_TRUE(surface);
  EXPECT_NEAR(surface->at({0, 4}), 2, 1e-12);
  EXPECT_NEAR(surface->at({1, 1}), 1.25, 1e-12);
  EXPECT_THAT(only_repair(), HasSubstr("1 point lies where another lies"));
}

TEST_F(SurfaceFile, LineThroughPointsOfASceneInThePlane)
{
  plan.is_line = true;
  const auto surface = read_points_of_scene({{0, 10}, {20, 10}, {40, 0}});
  ASSERT_TRUE(surface);
  EXPECT_EQ(surface->at({10, 0}), 10);
  EXPECT_EQ(surface->at({30, 0}), 5);
  EXPECT_EQ(surface->at({40, 0}), 0);
  EXPECT_TRUE(std::isnan(surface->at({40.1, 0})));
  EXPECT_FALSE(read_points_of_scene({{0, 10}, {0, 10, 5}, {-1, 3}}));
  EXPECT_FALSE(read_points_of_scene({{0, 10}, {0, 11}}));
  ASSERT_EQ(problems.size(), 2U);
  EXPECT_THAT(problems[0].message, HasSubstr("point 2 has 3 numbers; here a point is [x, elevation]"));
  EXPECT_THAT(problems[1].message, HasSubstr("point 2 has 0 after 0"));
}

TEST_F(SurfaceFile, DepthIsCountedFromTheGround)
{
  SurfaceSpec spec;
  spec.depth = 4;
  EXPECT_FALSE(read(spec));
  EXPECT_THAT(only_problem(), HasSubstr("no ground"));
  plan.ground = [](const std::array<Real, 2>& place) { return plane(place[0], place[1]); };
  const auto surface = read(spec);
  ASSERT_TRUE(surface);
  EXPECT_DOUBLE_EQ(surface->at({east, north}), 696);
}

/// Two triangles over a square, one below the other's half, and an upright one.
constexpr std::array<std::array<Real, 9>, 4> facets{
    {{0, 0, 0, 10, 0, 10, 10, 10, 10}, {0, 0, 0, 10, 10, 10, 0, 10, 0}, {0, 0, -5, 10, 0, -5, 10, 10, -5}, {0, 0, 0, 0, 10, 0, 0, 10, 50}}};

std::string ascii_stl()
{
  std::string text = "solid ground\n";
  for (const auto& f : facets)
    text += fmt::format("facet normal 0 0 1\n outer loop\n  vertex {} {} {}\n  vertex {} {} {}\n  vertex {} {} {}\n endloop\nendfacet\n",
                        f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7], f[8]);
  return text + "endsolid\n";
}

std::string binary_stl()
{
  std::string bytes(80, ' ');
  bytes.replace(0, 5, "solid");  // as some programs write it
  const auto put = [&](const auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof(value)); };
  put(static_cast<std::uint32_t>(facets.size()));
  for (const auto& f : facets) {
    for (int d = 0; d < 3; ++d)
      put(0.0F);
    for (const Real x : f)
      put(static_cast<float>(x));
    put(std::uint16_t{0});
  }
  return bytes;
}

TEST_F(SurfaceFile, BothKindsOfStlGiveTheTopmostTriangle)
{
  write_whole(folder / "ascii.stl", ascii_stl());
  write_whole(folder / "binary.stl", binary_stl());
  for (const char* name : {"ascii.stl", "binary.stl"}) {
    const auto ground = read(name);
    ASSERT_TRUE(ground) << name;
    for (const Real x : {0.5, 3.0, 9.0})
      for (const Real y : {0.0, 1.0, 3.0, 8.0})
        EXPECT_NEAR(ground->at({x, y}), x, 1e-9) << name << x << ' ' << y;
    EXPECT_TRUE(std::isnan(ground->at({11, 5})));
  }
  EXPECT_THAT(repairs, IsEmpty());
}

TEST_F(SurfaceFile, BrokenStlIsNamedByItsPlace)
{
  std::string text = ascii_stl();
  text.replace(text.find("vertex 10"), 9, "vertex 1x");
  write_whole(folder / "ascii.stl", text);
  write_whole(folder / "binary.stl", binary_stl().substr(0, 250));
  write_whole(folder / "none.stl", "PK");
  for (const char* name : {"ascii.stl", "binary.stl", "none.stl"})
    EXPECT_FALSE(read(name)) << name;
  ASSERT_EQ(problems.size(), 3U);
  EXPECT_EQ(problems[0].where.line, 5);
  EXPECT_THAT(problems[0].message, HasSubstr("'1x' is no coordinate"));
  EXPECT_THAT(problems[1].message, HasSubstr("of 4 triangles of a binary STL file there would be 284 bytes, not 250"));
  EXPECT_THAT(problems[2].message, HasSubstr("no STL file"));
}

TEST_F(SurfaceFile, OutlinesInDegreesAreBroughtToTheMap)
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

TEST_F(SurfaceFile, GeojsonInMetresIsTakenForTheMapAndThatIsTold)
{
  plan.crs = "EPSG:32633";
  write_whole(folder / "dam.geojson",
              R"({"type": "Polygon", "coordinates": [[[512000, 5180000], [512010, 5180000], [512010, 5180010], [512000, 5180000]]]})");
  const auto polygons = read_outlines("dam.geojson", {}, plan, problems, repairs);
  ASSERT_EQ(polygons.size(), 1U);
  EXPECT_THAT(polygons[0].outer, ElementsAre(ElementsAre(512000, 5180000), ElementsAre(512010, 5180000), ElementsAre(512010, 5180010)));
  EXPECT_THAT(only_repair(), HasSubstr("its numbers are no degrees"));
}

TEST_F(SurfaceFile, OutlinesAsTextInATableHaveTheirHoles)
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

TEST_F(SurfaceFile, FileWithoutOutlinesIsAProblemOfTheScene)
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
