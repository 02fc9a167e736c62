// Run-out of bodies that move as they began to: every number and every map has a closed form.
#include <gmock/gmock.h>

#include <cmath>

#include "app/observers/runout_distance.hpp"
#include "io/output/summary_json.hpp"
#include "io/terrain/raster_file.hpp"
#include "tests/app/program.hpp"

namespace talus::runout_test {
namespace {

using testing::HasSubstr;

TEST(Reach, GoesFromTheHighestPlaceToTheFurthest)
{
  const std::vector<Vec3> then{{0, 0, 10}, {1, 0, 12}, {2, 0, 9}}, now{{3, 0, 8}, {9, 0, 5}, {21, 0, 2}};
  const std::vector<Real> mass{98.5, 1, 0.5};
  const auto all = reach_of(then, now, mass, Vec3::UnitZ(), 1);
  ASSERT_TRUE(all);
  EXPECT_EQ(all->crown, Vec3(1, 0, 12));
  EXPECT_EQ(all->front, Vec3(21, 0, 2));
  EXPECT_DOUBLE_EQ(all->height, 10);
  EXPECT_DOUBLE_EQ(all->length, 20);
  const auto most = reach_of(then, now, mass, Vec3::UnitZ(), 0.99);  // half a percent lies beyond
  EXPECT_EQ(most->front, Vec3(9, 0, 5));
  EXPECT_EQ(reach_of(then, now, mass, Vec3::UnitZ(), 0.98)->front, Vec3(3, 0, 8));
  EXPECT_FALSE(reach_of({}, {}, {}, Vec3::UnitZ(), 1));
}

TEST(Reach, DoesNotDependOnTheRoundingOfPlacesThatAreEqual)
{
  std::vector<Vec3> then, now;  // a block whose top is level and whose front is upright, and a light chip ahead
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 10; ++j)
      then.emplace_back(0.1 * i, 0, 3 + 0.1 * j);
  then.emplace_back(1.5, 0, 3.9);
  for (const Vec3& x : then)
    now.push_back(x + (x[0] < 1.2 ? Vec3(2, 0, -1) : Vec3(3, 0, -1)));
  std::vector<Real> mass(100, 1);
  mass.push_back(0.5);
  for (const int seed : {0, 1, 2, 3}) {
    std::vector<Vec3> blurred = then;
    for (std::size_t p = 0; p < blurred.size(); ++p)  // as a displacement of single precision brings it
      blurred[p] += seed * 1e-7 * Vec3(std::sin(seed + 3.0 * static_cast<Real>(p)), 0, std::cos(seed + 2.0 * static_cast<Real>(p)));
    const auto reach = reach_of(blurred, now, mass, Vec3::UnitZ(), 0.99);
    ASSERT_TRUE(reach);
    EXPECT_NEAR(reach->length, 2.9, 1e-5) << "from the rear edge of the top to the front of the block";
    EXPECT_NEAR(reach->height, 1.9, 1e-5) << "down to the foot of the front";
    EXPECT_NEAR(reach->crown[0], 0, 1e-5);
  }
}

TEST(Reach, ASpeedOfTheBulkLeavesOutTheFastestPartOfTheMass)
{
  const std::vector<Real> speed{1, 12, 3, 2}, mass{50, 0.5, 1, 48.5};
  EXPECT_EQ(not_exceeded_by(speed, mass, 1), 12);
  EXPECT_EQ(not_exceeded_by(speed, mass, 0.99), 3) << "half a percent is faster";
  EXPECT_EQ(not_exceeded_by(speed, mass, 0.98), 2) << "one and a half percent are";
  EXPECT_EQ(not_exceeded_by({}, {}, 0.99), 0);
}

class RunOut : public Program {
 protected:
  HistoryTable table(const std::string& file) const { return read_history(folder_ / file); }
  Raster map(const std::string& name) const { return read_raster(folder_ / ("out/maps/" + name)); }
};

/// Half a cubic metre of 2000 kg/m^3 flies 2 m along x in 1 s.
std::string flying_block(const std::string& runout)
{
  return "title: Flying block\ndimension: 3\nmesh: {grid: {low: [0, 0, 0], high: [4, 1, 1], cells: [8, 2, 2]}}\n"
         "materials: [{name: stuff, law: neo_hookean, density: 2000, youngs_modulus: 1.0e5, poisson_ratio: 0.3}]\n"
         "bodies: [{name: block, material: stuff, shape: {type: box, low: [0, 0, 0], high: [1, 1, 0.5]}, particles_per_cell: 4, velocity: "
         "[2, 0, 0]}]\ntime: {end: 1}\noutputs:\n  runout: {every: 0.05, cell: 0.25" +
         runout + "}\n";
}

TEST_F(RunOut, OfAFlyingBlockIsThatOfItsMotion)
{
  write("scene.yaml",
        flying_block(", moved: 0, csv: true, mass_share: 1, frames_every: 0.5, sections: [{name: axis, along: [[0, 0.5], [4, 0.5]]}]"));
  const Outcome outcome = talus("run scene.yaml --out out");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("run-out: H "));
  EXPECT_THAT(outcome.out, HasSubstr("still moving"));

  const HistoryTable rows = table("out/runout.csv");
  EXPECT_NEAR(last(rows, "volume"), 0.5, 1e-12);
  EXPECT_NEAR(last(rows, "centre_L"), 2, 1e-9);
  EXPECT_NEAR(last(rows, "centre_H"), 0, 1e-9);
  EXPECT_NEAR(last(rows, "centre_x"), 2.5, 1e-9);
  EXPECT_NEAR(last(rows, "largest_speed"), 2, 1e-9);
  EXPECT_NEAR(last(rows, "mean_speed"), 2, 1e-9);
  EXPECT_NEAR(last(rows, "bulk_speed"), 2, 1e-9);
  EXPECT_NEAR(last(rows, "kinetic"), 2000, 1e-6);
  EXPECT_NEAR(last(rows, "front_x") - first(rows, "front_x"), 2, 0.5) << "another particle may be the furthest";
  EXPECT_GE(rows.rows(), 15U);
  EXPECT_EQ(first(rows, "frame"), 0) << "the number of its map, by which the map is drawn";

  const auto numbers = read_summary(folder_ / "out/summary.json").numbers;
  ASSERT_NE(find_number(numbers, "runout.volume"), nullptr);
  EXPECT_NEAR(find_number(numbers, "runout.volume")->value, 0.5, 1e-12);
  EXPECT_TRUE(std::isnan(find_number(numbers, "runout.stopped")->value));

  const Raster thickness = map("thickness.tif");
  ASSERT_EQ(thickness.columns, 16);
  ASSERT_EQ(thickness.rows, 4);
  EXPECT_NEAR(thickness.dx, 0.25, 1e-12);
  Real volume = 0;
  for (Index row = 0; row < 4; ++row)
    for (Index column = 0; column < 16; ++column) {
      const Real h = thickness.at(column, row);
      volume += std::isnan(h) ? 0 : h * thickness.dx * thickness.dy;
      if (column < 7 || column > 12) {
        EXPECT_TRUE(std::isnan(h)) << column << " " << row;
      } else if (column > 8 && column < 11) {
        EXPECT_NEAR(h, 0.5, 0.25) << column << " " << row;
      }
    }
  EXPECT_NEAR(volume, 0.5, 1e-7) << "single precision in the file";
  const Raster source = map("source.tif"), speed = map("speed_max.tif"), ground = map("ground.tif");
  EXPECT_FALSE(std::isnan(source.at(1, 1)));
  EXPECT_TRUE(std::isnan(source.at(8, 1)));
  EXPECT_NEAR(speed.at(6, 2), 2, 1e-6);
  EXPECT_NEAR(ground.at(1, 1), 0.5, 0.12) << "the block itself, at the start";
  EXPECT_EQ(ground.at(8, 1), 0) << "the floor of the mesh";
  EXPECT_TRUE(exists("out/maps/thickness.csv") && exists("out/maps/thickness_0000.tif") && exists("out/maps/thickness_0002.tif"));
  EXPECT_FALSE(exists("out/maps/thickness_0003.tif") || exists("out/maps/erosion.tif"));

  const HistoryTable section = table("out/sections/axis.csv");
  const auto distance = section["distance"], arrival = section["arrival"];
  ASSERT_TRUE(distance && arrival);
  int seen = 0;
  for (std::size_t i = 0; i < distance->size(); ++i)
    if (const Real x = (*distance)[i]; x > 1.5 && x < 2.6) {
      EXPECT_NEAR((*arrival)[i], (x - 1) / 2, 0.15) << x;
      ++seen;
    }
  EXPECT_GE(seen, 3);

  const Outcome drawn = talus("map out --only thickness_max sections --size 400x300");
  EXPECT_EQ(drawn.code, 0) << drawn.err;
  EXPECT_TRUE(exists("out/pictures/map_thickness_max.png") && exists("out/pictures/section_axis.png")) << drawn.out;
  const Outcome misspelt = talus("map out --only thickness_mx");
  EXPECT_EQ(misspelt.code, 2);
  EXPECT_THAT(misspelt.err, HasSubstr("thickness_max"));
  ASSERT_EQ(talus("run scene.yaml --out out --quiet --set time.end=0.01").code, 0);
  EXPECT_FALSE(exists("out/maps/thickness_0002.tif")) << "of the run before";
}

/// A block glides to a stop on a rough floor, a light one flies on above it: the slide is at rest although something is fast.
TEST_F(RunOut, IsAtRestWhenTheMassIsAndNotWhenItsEnergyIsSmall)
{
  write("scene.yaml",
        "title: Stop\ndimension: 2\nmesh: {grid: {low: [0, 0], high: [6, 3], cells: [24, 12]}}\n"
        "materials:\n  - {name: stone, law: linear_elastic, density: 2000, youngs_modulus: 1.0e6, poisson_ratio: 0.3}\n"
        "  - {name: foam, law: linear_elastic, density: 2, youngs_modulus: 1.0e3, poisson_ratio: 0.3}\n"
        "bodies:\n  - {name: block, material: stone, shape: {type: box, low: [0, 0], high: [1, 0.5]}, velocity: [2, 0]}\n"
        "  - {name: feather, material: foam, shape: {type: box, low: [0.5, 2.5], high: [0.75, 2.75]}, velocity: [4, 1]}\n"
        "loads: [{type: gravity, acceleration: [0, -5]}]\nboundaries: [{type: friction, on: y_min, coefficient: 0.5}]\n"
        "on_exit: delete\ntime: {end: 1.1}\noutputs: {runout: {every: 0.02, cell: 0.2, moved: 0.01}}\n");
  const Outcome outcome = talus("run scene.yaml --out out");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const HistoryTable rows = table("out/runout.csv");
  const auto time = rows["time"], mean = rows["mean_speed"];
  ASSERT_TRUE(time && mean);
  Real since = -1;
  for (std::size_t i = 0; i < time->size(); ++i)
    if ((*mean)[i] * (*time)[i] >= 0.2)
      since = -1;
    else if (since < 0)
      since = (*time)[i];
  const Real stopped = find_number(read_summary(folder_ / "out/summary.json").numbers, "runout.stopped")->value;
  EXPECT_NEAR(stopped, since, 1e-9);
  EXPECT_NEAR(stopped, 0.68, 0.06) << "(2 - 0.5 5 t) t = 0.2";
  EXPECT_GT(last(rows, "largest_speed"), 4) << "of the feather";
  EXPECT_THAT(outcome.out, HasSubstr("at rest since t = "));
  EXPECT_THAT(outcome.out, HasSubstr("1 % of the mass faster than "));
}

/// Two blocks in a plane: one of 1 m/s, the other of half that, which counts as ground.
TEST_F(RunOut, CountsWhatHasMovedAndWhatItTookAlong)
{
  write("scene.yaml",
        "title: Two blocks\ndimension: 2\nmesh: {grid: {low: [0, 0], high: [8, 1], cells: [16, 2]}}\n"
        "materials: [{name: stuff, law: neo_hookean, density: 2000, youngs_modulus: 1.0e5, poisson_ratio: 0.3}]\nbodies:\n"
        "  - {name: slide, material: stuff, shape: {type: box, low: [0, 0], high: [1, 0.5]}, velocity: [1, 0]}\n"
        "  - {name: bed, material: stuff, shape: {type: box, low: [5, 0], high: [6, 0.5]}, velocity: [0.5, 0]}\n"
        "time: {end: 1}\noutputs: {runout: {every: 0.1, cell: 0.25, moved: 0.2, eroded: [bed]}}\n");
  const Outcome outcome = talus("run scene.yaml --quiet --out out");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const HistoryTable rows = table("out/runout.csv");
  const auto time = rows["time"], volume = rows["volume"], entrained = rows["entrained"];
  ASSERT_TRUE(time && volume && entrained);
  for (std::size_t i = 0; i < time->size(); ++i) {
    const Real t = (*time)[i];
    if (std::abs(t - 0.2) < 0.05 || std::abs(t - 0.4) < 0.05)
      continue;  // when they pass 0.2 m
    EXPECT_NEAR((*volume)[i], t < 0.2 ? 0 : t < 0.4 ? 0.5 : 1, 1e-9) << t;
    EXPECT_NEAR((*entrained)[i], t < 0.4 ? 0 : 0.5, 1e-9) << t;
  }
  const HistoryTable plane = table("out/sections/plane.csv");
  const auto x = plane["x"], erosion = plane["erosion"];
  ASSERT_TRUE(x && erosion);
  Real eroded = 0;
  for (std::size_t i = 0; i < x->size(); ++i) {
    const Real depth = (*erosion)[i];
    eroded += std::isnan(depth) ? 0 : depth * 0.25;
    if ((*x)[i] < 4.7 || (*x)[i] > 6.3) {
      EXPECT_TRUE(std::isnan(depth)) << (*x)[i];
    }
  }
  EXPECT_NEAR(eroded, 0.5, 1e-9);
}

/// An elastic layer 1 m high between smooth walls, nu / (1 - nu) = 1/2: it pushes with rho g h^2 / 4, a third of the height above the floor.
TEST_F(RunOut, PushOfALayerOnAWallIsThatOfEarthPressureAtRest)
{
  write("scene.yaml",
        "title: Layer\ndimension: 2\nmesh: {grid: {low: [0, 0], high: [2, 1.25], cells: [16, 10]}}\n"
        "materials: [{name: soil, law: linear_elastic, density: 2000, youngs_modulus: 1.0e7, poisson_ratio: 0.3333333333}]\n"
        "bodies: [{name: layer, material: soil, shape: {type: box, low: [0, 0], high: [2, 1]}, particles_per_cell: 6}]\n"
        "loads: [{type: gravity, acceleration: [0, -9.81]}]\n"
        "boundaries: [{type: roller, on: x_min}, {type: roller, on: x_max}, {type: roller, on: y_min}]\n"
        "stages: [{type: geostatic, duration: 2, residual: 1.0e-2, damping: 0.7, initial_stress: {k0: 0.5}}, {type: run, duration: 0.05}]\n"
        "outputs: {history: {every: 0.05, walls: [{on: x_min}, {on: y_min}]}}\n");
  const Outcome outcome = talus("run scene.yaml --quiet --out out");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const HistoryTable rows = history("out");
  const Real weight = 2000 * 9.81;  // of a cubic metre
  EXPECT_NEAR(last(rows, "push_x_min"), weight / 4, 0.02 * weight / 4);
  EXPECT_NEAR(last(rows, "attack_x_min_y"), 1. / 3, 0.03);
  EXPECT_NEAR(last(rows, "attack_x_min_x"), 0, 1e-12);
  EXPECT_NEAR(last(rows, "touched_x_min"), 1, 0.2) << "up to a cell and a half more: nodes with mass";
  EXPECT_NEAR(last(rows, "pressure_x_min"), last(rows, "push_x_min") / last(rows, "touched_x_min"), 1e-9);
  EXPECT_NEAR(last(rows, "push_y_min"), 2 * weight, 0.02 * 2 * weight);
  EXPECT_NEAR(last(rows, "attack_y_min_x"), 1, 0.02);
}

TEST_F(RunOut, SectionsThatLeaveTheMeshAreToldBefore)
{
  write("scene.yaml", flying_block(", sections: [{name: axis, along: [[0, 0.5], [9, 0.5]]}]"));
  const Outcome outcome = talus("check scene.yaml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("scene.yaml:8:"));
  EXPECT_THAT(outcome.err, HasSubstr("corner 2 is outside of the mesh: 9 m does not lie between 0 and 4 m"));
}

TEST_F(RunOut, IsNotDrawnOfARunWithoutIt)
{
  write("scene.yaml", block_scene("time: {end: 0.01}\n"));
  ASSERT_EQ(talus("run scene.yaml --quiet --out out").code, 0);
  const Outcome outcome = talus("map out");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("outputs.runout"));
}

}  // namespace
}  // namespace talus::runout_test
