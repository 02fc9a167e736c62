// Water in the pores and the stress at the start, by their closed forms.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/output/summary_json.hpp"
#include "io/output/vtk.hpp"
#include "tests/app/program.hpp"

namespace talus::water_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr Real g = 9.81, weight_of_water = 9810, dry = 1800, wet = 2000, height = 10;

const std::string soil =
    "{name: soil, law: mohr_coulomb, density: 1800, youngs_modulus: 1.0e8, poisson_ratio: 0.3, friction_angle: 30, cohesion: 1.0e3}";
const std::string elastic = "{name: soil, law: hencky, density: 1800, youngs_modulus: 1.0e9, poisson_ratio: 0.25}";
const std::string whole = "{name: column, material: soil, region: all, particles_per_cell: 4, saturated_density: 2000}";
const std::string under_k0 = "{type: geostatic, duration: 2, residual: 2.0e-3, initial_stress: {k0: 0.5}}";

/// A column of soil 10 m high between smooth walls, dry down to 3 m.  Every part may be replaced.
struct Column {
  int dimension = 2;
  std::string material = soil;
  std::string bodies = whole;
  std::string water = "water: {table: {depth: 3}}\n";
  std::string initial = "";
  std::string stages = under_k0;
  std::string fields = "stress, effective_stress, pore_pressure";
  std::string text() const
  {
    const bool solid = dimension == 3;
    std::string all = bodies;
    for (auto at = all.find("region: all"); at != all.npos; at = all.find("region: all"))
      all.replace(at, 11,
                  solid ? "shape: {type: box, low: [0, 0, 0], high: [1, 1, 10]}" : "shape: {type: box, low: [0, 0], high: [1, 10]}");
    const std::string mesh =
        solid ? "{low: [0, 0, 0], high: [1, 1, 10], cells: [1, 1, 10]}" : "{low: [0, 0], high: [1, 10], cells: [2, 20]}";
    const std::string walls = "{type: roller, on: x_min}, {type: roller, on: x_max}, {type: roller, on: y_min}";
    return "title: Column\ndimension: " + std::to_string(dimension) + "\nmesh: {grid: " + mesh + "}\nmaterials: [" + material +
           "]\nbodies: [" + all + "]\n" + initial + water +
           "loads: [{type: gravity, acceleration: " + (solid ? "[0, 0, -9.81]" : "[0, -9.81]") + "}]\nboundaries: [" + walls +
           (solid ? ", {type: roller, on: y_max}, {type: roller, on: z_min}" : "") + "]\nstages: [" + stages +
           "]\noutputs:\n  checkpoint: {at_end: true}\n  particles: {every: 100, fields: [" + fields + "]}\n  history: {every: 100}\n";
  }
};

/// What one particle is expected to have, by its depth [m].
Real weight_above(Real depth) { return g * (dry * std::min(depth, Real{3}) + wet * std::max(depth - 3, Real{0})); }
Real pore_pressure(Real depth) { return weight_of_water * std::max(depth - 3, Real{0}); }

/// Particles of a file, by the names of their fields.
struct Seen {
  StoredParticles file;
  const StoredField& operator[](std::string_view name) const
  {
    const auto found = std::find_if(file.fields.begin(), file.fields.end(), [&](const StoredField& f) { return f.name == name; });
    EXPECT_NE(found, file.fields.end()) << name;
    return *found;
  }
  std::size_t size() const { return file.ids.size(); }
};

class WaterRun : public Program {
 protected:
  Outcome run(const std::string& name, const Column& column) const
  {
    write(name + ".yaml", column.text());
    return talus("run " + name + ".yaml --out " + name);
  }
  void run_well(const std::string& name, const Column& column) const
  {
    const Outcome outcome = run(name, column);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(without_losses(outcome.err), "");
  }
  Seen at_begin(const std::string& name) const { return {read_particles(read_pvd(folder_ / (name + "/particles.pvd")).front().second)}; }
  Seen at_end(const std::string& name) const { return {read_particles(read_pvd(folder_ / (name + "/particles.pvd")).back().second)}; }
  Real number(const std::string& run, const std::string& name) const
  {
    const SummaryBack summary = read_summary(folder_ / (run + "/summary.json"));
    const NamedValue* found = find_number(summary.numbers, name);
    EXPECT_NE(found, nullptr) << name;
    return found == nullptr ? std::numeric_limits<Real>::quiet_NaN() : found->value;
  }
};

/// Stresses along and across gravity and pore pressures beside those of expected(depth): root of the mean square difference over the largest.
struct Difference {
  Real along = 0, across = 0, pore = 0;
};
template <class F>
Difference difference(const Seen& seen, int dimension, std::string_view stress, F&& expected)
{
  Difference mean;
  const auto& x = seen["position"].values;
  const auto& s = seen[stress].values;
  const auto& u = seen["pore_pressure"].values;
  const auto up = static_cast<std::size_t>(dimension - 1);
  for (std::size_t p = 0; p < seen.size(); ++p) {
    const Real depth = height - x[3 * p + up];
    const auto [along, across, pore] = expected(depth);
    const auto square = [&](Real difference, Real largest) {
      return difference * difference / (largest * largest * static_cast<Real>(seen.size()));
    };
    mean.along += square(s[6 * p + up] - along, weight_above(height));
    mean.across += square(s[6 * p] - across, weight_above(height));
    mean.pore += square(u[p] - pore, pore_pressure(height));
  }
  return {std::sqrt(mean.along), std::sqrt(mean.across), std::sqrt(mean.pore)};
}

TEST_F(WaterRun, AColumnUnderK0IsAtRestWithTheStressesOfItsClosedForm)
{
  for (const int dimension : {2, 3}) {
    run_well("column", {.dimension = dimension});
    const auto total = [](Real depth) {
      const Real u = pore_pressure(depth), along = weight_above(depth) - u;
      return std::array{-along - u, -0.5 * along - u, u};
    };
    const auto effective = [](Real depth) {
      const Real u = pore_pressure(depth), along = weight_above(depth) - u;
      return std::array{-along, -0.5 * along, u};
    };
    for (const bool end : {false, true}) {
      const Seen seen = end ? at_end("column") : at_begin("column");
      const Difference in_total = difference(seen, dimension, "stress", total),
                       in_effect = difference(seen, dimension, "effective_stress", effective);
      const Real allowed = end ? 0.01 : 1e-7;  // at the end as without water: what the kernel makes of the rim of a column two cells wide
      for (const Difference& apart : {in_total, in_effect}) {
        EXPECT_LT(apart.along, allowed) << dimension;
        EXPECT_LT(apart.across, allowed) << dimension;
        EXPECT_LT(apart.pore, 1e-6) << dimension;
      }
    }
    EXPECT_GT(number("column", "stages[0].residual_at_begin"), number("column", "stages[0].residual"));
    EXPECT_LT(number("column", "stages[0].residual_at_begin"), 0.3);
    EXPECT_LT(number("column", "stages[0].residual"), 2e-3);
    EXPECT_NEAR(number("column", "bodies[0].mass"), 3 * dry + 7 * wet, 1e-9 * 7 * wet);
  }
}

/// Elastic soil between smooth walls that gravity grows on: horizontal over vertical stress is nu / (1 - nu) of effective stresses.
TEST_F(WaterRun, GravityThatGrowsTakesTheWaterAlong)
{
  run_well("column", {.material = elastic, .stages = "{type: geostatic, duration: 3, ramp: 0.3, residual: 1.0e-3}"});
  const auto effective = [](Real depth) {
    const Real u = pore_pressure(depth), along = weight_above(depth) - u;
    return std::array{-along, -along / 3, u};
  };
  const Difference apart = difference(at_end("column"), 2, "effective_stress", effective);
  EXPECT_LT(apart.along, 0.01);
  EXPECT_LT(apart.across, 0.01);
  EXPECT_LT(apart.pore, 1e-6);
  EXPECT_LT(number("column", "balances.energy.closure"), 1e-2);
  const Seen begin = at_begin("column");
  for (const Real u : begin["pore_pressure"].values)
    EXPECT_EQ(u, 0) << "no weight yet";
}

TEST_F(WaterRun, UndrainedBodiesKeepTotalStressAndSuctionIsLimited)
{
  const std::string halves =
      "{name: clay, material: soil, shape: {type: box, low: [0, 0], high: [1, 4]}, particles_per_cell: 4, saturated_density: 2000}, "
      "{name: sand, material: soil, shape: {type: box, low: [0, 4], high: [1, 10]}, particles_per_cell: 4, saturated_density: 2000}";
  const Column column{.bodies = halves, .water = "water: {table: {elevation: 7}, suction: 1.0e4, bodies: [sand]}\n"};
  run_well("column", column);
  const auto expected = [](Real depth) {
    const bool drained = depth < 6;
    const Real u = drained ? std::max(weight_of_water * (depth - 3), -1e4) : 0, effective = weight_above(depth) - u;
    return std::array{-effective, -0.5 * effective, u};
  };
  const Difference apart = difference(at_begin("column"), 2, "effective_stress", expected);
  EXPECT_LT(apart.along, 1e-7);
  EXPECT_LT(apart.across, 1e-7);
  EXPECT_LT(apart.pore, 1e-6);
  const Outcome check = talus("check column.yaml");
  EXPECT_THAT(check.out, HasSubstr("body \"clay\": 128 particles, total stress\n"));
  EXPECT_THAT(check.out, HasSubstr("body \"sand\": 192 particles, effective stress, 96 below the water table\n"));
}

TEST_F(WaterRun, K0IsOfABodyOfItsDepthOrOfItsFriction)
{
  const auto ratios = [&](const std::string& rule) {
    // Ended after some steps, in the midst of its first swing, the run would leave more of its energy open than it may.
    run_well("column", {.stages = "{type: geostatic, duration: 2, residual: 0.05, initial_stress: {" + rule + "}}"});
    const Seen seen = at_begin("column");
    std::vector<std::array<Real, 2>> by_depth;
    for (std::size_t p = 0; p < seen.size(); ++p)
      by_depth.push_back({height - seen["position"].values[3 * p + 1],
                          seen["effective_stress"].values[6 * p] / seen["effective_stress"].values[6 * p + 1]});
    return by_depth;
  };
  for (const auto& [depth, ratio] : ratios("k0_table: [[2, 1], [6, 0.4]]"))
    EXPECT_NEAR(ratio, depth < 2 ? 1 : depth > 6 ? 0.4 : 1 - 0.15 * (depth - 2), 1e-4) << depth;
  for (const auto& [depth, ratio] : ratios("from_friction: true"))
    EXPECT_NEAR(ratio, 0.5, 1e-6);
  for (const auto& [depth, ratio] : ratios("from_friction: true, ocr: 4"))
    EXPECT_NEAR(ratio, 1, 1e-6);
  for (const auto& [depth, ratio] : ratios("k0: 0.9, bodies: [{body: column, k0: 0.7}]"))
    EXPECT_NEAR(ratio, 0.7, 1e-6);
}

/// Over the toe a level table is cut at the ground; where it is above most of it the scene is refused.
TEST_F(WaterRun, ATableAboveTheGroundIsCutThereOrRefused)
{
  const auto slope = [](const std::string& table) {
    return "title: Slope\ndimension: 2\nmesh: {size: 1, regions: [{name: soil, shape: {type: polygon, points: [[0, 0], [20, 0], [20, 2], "
           "[12, 2], [6, 8], [0, 8]]}}, {name: air, shape: {type: polygon, points: [[20, 2], [20, 8], [6, 8], [12, 2]]}}]}\nmaterials: [" +
           soil + "]\nbodies: [{name: slope, material: soil, region: soil, particles_per_cell: 4}]\nwater: {table: " + table +
           "}\nloads: [{type: gravity, acceleration: [0, -9.81]}]\nboundaries: [{type: fixed, on: y_min}, {type: roller, on: x_min}, "
           "{type: "
           "roller, on: x_max}]\ntime: {end: 0.01}\noutputs: {particles: {every: 1, fields: [pore_pressure]}}\n";
  };
  write("slope.yaml", slope("{points: [[0, 6], [12, 3], [20, 3]]}"));
  const Outcome cut = talus("run slope.yaml --out slope");
  ASSERT_EQ(cut.code, 0) << cut.err;
  EXPECT_THAT(cut.err,
              testing::ContainsRegex("warning: slope.yaml:6:16: the water table lies above the ground over 9(\\.[0-9]*)? m of 20 m of "
                                     "its plan, by up to 1 m at \\("));
  const Seen seen = at_begin("slope");
  Real most = 0;
  for (std::size_t p = 0; p < seen.size(); ++p) {
    const Real x = seen["position"].values[3 * p], y = seen["position"].values[3 * p + 1];
    const Real ground = std::clamp(14 - x, Real{2}, Real{8}), table = std::min(ground, x < 12 ? 6 - x / 4 : Real{3});
    most = std::max(most, std::abs(seen["pore_pressure"].values[p] - weight_of_water * std::max(table - y, Real{0})));
  }
  EXPECT_LT(most, 0.2 * weight_of_water) << "the table is known at the nodes and linear between them";
  write("lake.yaml", slope("{elevation: 9}"));
  const Outcome lake = talus("check lake.yaml");
  EXPECT_EQ(lake.code, 2);
  EXPECT_THAT(lake.err, HasSubstr("lake.yaml:6:16: error: water.table: the water table lies above the ground over 20 m of 20 m"));
  write("short.yaml", slope("{points: [[0, 6], [10, 2]]}"));
  EXPECT_THAT(talus("check short.yaml").err, HasSubstr("short.yaml:6:16: error: water.table: the water table is not known everywhere"));
  write("deep.yaml", slope("{elevation: -3}"));
  EXPECT_THAT(talus("check deep.yaml").err, HasSubstr("no particle of a drained body lies below the water table"));
}

/// Water follows places, not particles: what moves up through a level table loses its pressure.
TEST_F(WaterRun, ThePressureIsThatOfThePlaceWhileABodyMoves)
{
  const std::string scene = block_scene(
      "water: {table: {elevation: 0.8}}\nloads: [{type: gravity, acceleration: [0, -9.81]}]\nboundaries: [{type: roller, on: y_min}]\n"
      "time: {end: 0.1}\noutputs: {particles: {every: 1, fields: [pore_pressure]}}\n",
      ", velocity: [0, 4]");
  write("block.yaml", scene);
  ASSERT_EQ(talus("run block.yaml --out block").code, 0);
  const Seen seen = at_end("block");
  std::size_t submerged = 0;
  for (std::size_t p = 0; p < seen.size(); ++p) {
    const Real x = seen["position"].values[3 * p], y = seen["position"].values[3 * p + 1];
    if (std::abs(x - 1) < 0.2) {  // beside the body the table lies at the floor
      EXPECT_NEAR(seen["pore_pressure"].values[p], weight_of_water * std::max(0.8 - y, 0.0), 1e-5 * weight_of_water);
      submerged += y < 0.8 ? 1 : 0;
    }
  }
  EXPECT_GT(submerged, 5u);
}

/// The table falls by 4 m and rises again: what the skeleton carries is the total stress of the same weight, less the new pore pressure.
TEST_F(WaterRun, EachStageMayHaveItsOwnTable)
{
  const std::string lower = "water: {table: {depth: 7}}", higher = "water: {table: {elevation: 9}}";
  const Column column{.stages = under_k0 + ", {type: geostatic, name: drawdown, duration: 3, residual: 2.0e-3, " + lower +
                                "}, {type: run, name: rain, duration: 1.0e-4, " + higher + "}"};
  run_well("column", column);
  const auto pore = [](Real depth_of_table) {
    return [=](Real depth) { return weight_of_water * std::max(depth - depth_of_table, Real{0}); };
  };
  // The last stage is too short for anything to move: effective stresses are those of the drawdown, with the pressure of the new table.
  const auto after_drawdown = [&](Real depth) {
    const Real effective = weight_above(depth) - pore(7)(depth), u = pore(1)(depth);
    return std::array{-effective, Real{0}, u};
  };
  const Seen end = at_end("column");
  const Difference apart = difference(end, 2, "effective_stress", after_drawdown);
  EXPECT_LT(apart.along, 0.01) << "the weight stays, the water has left";
  EXPECT_LT(apart.pore, 1e-6);
  EXPECT_NEAR(number("column", "bodies[0].mass"), 3 * dry + 7 * wet, 1e-9 * 7 * wet) << "what was saturated stays so";
  EXPECT_LT(number("column", "balances.energy.closure"), 1e-2);
  const Outcome check = talus("check column.yaml");
  EXPECT_THAT(check.out, HasSubstr("stage 1 \"drawdown\": the water table falls by up to 4 m\n"));
  EXPECT_THAT(check.out, HasSubstr("stage 2 \"rain\": the water table rises by up to 6 m\n"));
  EXPECT_THAT(read("column/summary.json"), HasSubstr("the water table falls by up to 4 m"));

  write("lake.yaml", Column{.stages = under_k0 + ", {type: run, duration: 1, water: {table: {elevation: 12}}}"}.text());
  const Outcome lake = talus("check lake.yaml");
  EXPECT_EQ(lake.code, 2);
  EXPECT_THAT(lake.err, HasSubstr("stages[1].water.table: the water table lies above the ground over 1 m of 1 m"));
}

/// What comes with a stage is saturated below the table of that stage.
TEST_F(WaterRun, ABodyThatAppearsIsSaturatedBelowTheTableOfItsStage)
{
  const std::string halves =
      "{name: clay, material: soil, shape: {type: box, low: [0, 0], high: [1, 6]}, particles_per_cell: 4, saturated_density: 2000}, "
      "{name: fill, material: soil, shape: {type: box, low: [0, 6], high: [1, 10]}, particles_per_cell: 4, saturated_density: 2000}";
  const Outcome outcome =
      run("column", {.bodies = halves,
                     .stages = "{type: run, duration: 1.0e-4}, {type: run, name: fill, duration: 1.0e-4, appear: [fill], water: {table: "
                               "{elevation: 8}}}"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NEAR(number("column", "bodies[0].mass"), 3 * dry + 3 * wet, 1e-9 * 7 * wet) << "3 m below its own ground at the start";
  EXPECT_NEAR(number("column", "bodies[1].mass"), 2 * dry + 2 * wet, 1e-9 * 7 * wet);
}

TEST_F(WaterRun, AnotherRunHandsOnItsWater)
{
  const std::string halves =
      "{name: clay, material: soil, shape: {type: box, low: [0, 0], high: [1, 4]}, particles_per_cell: 4, saturated_density: 2000}, "
      "{name: sand, material: soil, shape: {type: box, low: [0, 4], high: [1, 10]}, particles_per_cell: 4, saturated_density: 2000}";
  run_well("first", {.bodies = halves});
  const Seen end = at_end("first");
  const Column next{.bodies = "{name: clay, material: soil}, {name: sand, material: soil}",
                    .initial = "initial: {from: first}\n",
                    .stages = "{type: run, duration: 0.001}"};
  const auto most_apart = [&](const std::string& run, std::string_view here, auto&& there) {
    const Seen begin = at_begin(run);
    Real most = 0;
    for (std::size_t k = 0; k < begin[here].values.size(); ++k)
      most = std::max(most, std::abs(begin[here].values[k] - end[there(k / 6)].values[k]));
    return most / weight_above(height);
  };
  const auto total = [](std::size_t) { return "stress"; };
  const auto effective = [](std::size_t) { return "effective_stress"; };
  run_well("goes_on", next);
  EXPECT_LT(most_apart("goes_on", "stress", total), 1e-6);
  EXPECT_LT(most_apart("goes_on", "effective_stress", effective), 1e-6);
  Column changed = next;
  changed.water = "";
  run_well("without", changed);
  EXPECT_LT(most_apart("without", "stress", effective), 1e-6) << "the water is gone, the skeleton keeps its stress";
  changed.water = "water: {table: {elevation: 7}, bodies: [sand]}\n";
  run_well("undrained", changed);
  EXPECT_LT(most_apart("undrained", "stress", total), 1e-6);
  const auto& body = end["body"].values;
  EXPECT_LT(most_apart("undrained", "effective_stress", [&](std::size_t p) { return body[p] == 0 ? "stress" : "effective_stress"; }), 1e-6)
      << "from now on the clay's law sees total stress";
}

}  // namespace
}  // namespace talus::water_test
