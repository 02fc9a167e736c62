// Surfaces through points and triangles, from files and from the scene.
#include "tests/io/terrain/surface_files.hpp"

namespace talus::surface_file_test {
namespace {

using SurfacePoints = SurfaceFile;

TEST_F(SurfacePoints, ScatteredPointsAreTriangulated)
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

TEST_F(SurfacePoints, PointsOnAGridAreARaster)
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

TEST_F(SurfacePoints, WrongRowsOfPointsAreNamedByTheirLines)
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

TEST_F(SurfacePoints, PointsOnALineSpanNothing)
{
  write_whole(folder / "line.csv", "0,0,1\n1,1,2\n2,2,3\n5,5,1\n");
  testing::internal::CaptureStderr();
  EXPECT_FALSE(read("line.csv"));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");  // nor does qhull speak
  EXPECT_THAT(only_problem(), HasSubstr("lie on one line"));
}

TEST_F(SurfacePoints, PointsAtOnePlaceBecomeTheirMeanAndThatIsTold)
{
  const auto surface = read_points_of_scene({{0, 0, 1}, {4, 0, 1}, {0, 4, 1}, {0, 4, 3}});
  ASSERT_TRUE(surface);
  EXPECT_NEAR(surface->at({0, 4}), 2, 1e-12);
  EXPECT_NEAR(surface->at({1, 1}), 1.25, 1e-12);
  EXPECT_THAT(only_repair(), HasSubstr("1 point lies where another lies"));
}

TEST_F(SurfacePoints, LineThroughPointsOfASceneInThePlane)
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

TEST_F(SurfacePoints, DepthIsCountedFromTheGround)
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

TEST_F(SurfacePoints, BothKindsOfStlGiveTheTopmostTriangle)
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

TEST_F(SurfacePoints, BrokenStlIsNamedByItsPlace)
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

}  // namespace
}  // namespace talus::surface_file_test
