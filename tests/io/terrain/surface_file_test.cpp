// Surfaces and outlines of a scene, read from files; what is wrong with them and what is mended.
#include "tests/io/terrain/surface_files.hpp"

namespace talus::surface_file_test {
namespace {

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

}  // namespace
}  // namespace talus::surface_file_test
