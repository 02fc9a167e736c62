// Stress at the start as it is given, and how loads grow, by closed forms.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "io/output/summary_json.hpp"
#include "tests/app/program.hpp"

namespace talus::start_stress_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class StartStress : public Program {
 protected:
  Real number(const std::string& run, const std::string& name) const
  {
    const SummaryBack summary = read_summary(folder_ / (run + "/summary.json"));
    const NamedValue* found = find_number(summary.numbers, name);
    EXPECT_NE(found, nullptr) << name;
    return found == nullptr ? std::numeric_limits<Real>::quiet_NaN() : found->value;
  }
};

/// A block of a jittered mesh under the tractions of the stress sxx = -3, syy = -2, szz = -1, sxy = 0.5 [x 1e5 Pa].
std::string block(const std::string& kernel, const std::string& stress)
{
  return "title: Block\ndimension: 2\nmesh: {grid: {low: [0, 0], high: [2, 1], cells: [6, 3], jitter: 0.15}}\nkernel: " + kernel +
         "\nmaterials: [{name: rock, law: linear_elastic, density: 2500, youngs_modulus: 1.0e9, poisson_ratio: 0.25}]\n"
         "bodies: [{name: block, material: rock, region: all, particles_per_cell: 3}]\n"
         "loads:\n"
         "  - {type: traction, on: x_min, traction: [3.0e5, -0.5e5], carried_by: mesh}\n"
         "  - {type: traction, on: x_max, traction: [-3.0e5, 0.5e5], carried_by: mesh}\n"
         "  - {type: traction, on: y_min, traction: [-0.5e5, 2.0e5], carried_by: mesh}\n"
         "  - {type: traction, on: y_max, traction: [0.5e5, -2.0e5], carried_by: mesh}\n"
         "stages:\n  - {type: geostatic, duration: 0.1, residual: 1.0e-9, initial_stress: {stress: " +
         stress +
         "}}\n  - {type: run, duration: 0.05}\n"
         "outputs: {history: {every: 0.01, points: [{name: middle, at: [1, 0.5]}, {name: corner, at: [2, 1]}]}}\n";
}
const std::string matching = "{xx: -3.0e5, yy: -2.0e5, zz: -1.0e5, xy: 0.5e5}";

TEST_F(StartStress, AUniformBlockUnderMatchingTractionsStaysAtRestToRoundOff)
{
  for (const std::string kernel : {"linear", "projected"}) {  // weights of umls integrate a uniform stress to 1e-7 of its forces
    write("block.yaml", block(kernel, matching));
    const Outcome outcome = talus("run block.yaml --out out");
    ASSERT_EQ(outcome.code, 0) << kernel << outcome.err;
    EXPECT_LT(number("out", "stages[0].residual_at_begin"), 1e-11) << kernel;
    EXPECT_EQ(number("out", "stages[0].steps"), 20) << kernel << ": it is at rest from the beginning";
    const HistoryTable table = history("out");
    EXPECT_LT(last(table, "kinetic"), 1e-20) << kernel << ": of a stored energy of some 100 J";
    for (const std::string point : {"middle", "corner"}) {
      EXPECT_NEAR(last(table, point + "_sxx"), -3e5, 1e-5) << kernel;
      EXPECT_NEAR(last(table, point + "_syy"), -2e5, 1e-5) << kernel;
      EXPECT_NEAR(last(table, point + "_szz"), -1e5, 1e-5) << kernel;
      EXPECT_NEAR(last(table, point + "_sxy"), 0.5e5, 1e-5) << kernel;
      EXPECT_LT(std::hypot(last(table, point + "_ux"), last(table, point + "_uy")), 1e-14) << kernel;
    }
  }
}

/// The other way round: the run says how far a stress is from balance.
TEST_F(StartStress, WhatDoesNotMatchIsReportedAndMoves)
{
  write("block.yaml", block("projected", "{xx: -3.0e5, yy: -1.0e5, zz: -1.0e5, xy: 0.5e5}"));
  const Outcome outcome = talus("run block.yaml --out out --set stages[0].residual=1.0e-3 --set stages[0].duration=2");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_GT(number("out", "stages[0].residual_at_begin"), 0.1);
  EXPECT_NEAR(last(history("out"), "middle_syy"), -2e5, 4e3) << "the tractions win";
}

TEST_F(StartStress, EachBodyMayHaveItsOwnAndTakesThePorePressureAlong)
{
  write("column.yaml",
        "title: Layers\ndimension: 2\nmesh: {grid: {low: [0, 0], high: [1, 4], cells: [2, 8]}}\n"
        "materials: [{name: soil, law: linear_elastic, density: 2000, youngs_modulus: 1.0e8, poisson_ratio: 0.3}]\n"
        "bodies:\n  - {name: low, material: soil, shape: {type: box, low: [0, 0], high: [1, 2]}, particles_per_cell: 3}\n"
        "  - {name: high, material: soil, shape: {type: box, low: [0, 2], high: [1, 4]}, particles_per_cell: 3}\n"
        "water: {table: {elevation: 3}}\nloads: [{type: gravity, acceleration: [0, -10]}]\n"
        "boundaries: [{type: roller, where: x_min}, {type: roller, where: x_max}, {type: fixed, where: y_min}]\n"
        "stages: [{type: geostatic, duration: 5, residual: 1.0e-2, initial_stress: {k0: 0.5, bodies: [{body: low, stress: {xx: -1.0e4, yy: "
        "-3.0e4, zz: -2.0e4}}]}}]\n"
        "outputs: {history: {every: 100, points: [{name: p, at: [0.5, 1]}, {name: q, at: [0.5, 3.5]}]}}\n");
  const Outcome outcome = talus("run column.yaml --out out");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const HistoryTable table = history("out");
  const Real u = 9810 * (3 - first(table, "p_y"));
  EXPECT_NEAR(first(table, "p_sxx"), -1e4 - u, 1e-6);
  EXPECT_NEAR(first(table, "p_syy"), -3e4 - u, 1e-6);
  EXPECT_NEAR(first(table, "p_szz"), -2e4 - u, 1e-6);
  EXPECT_NEAR(first(table, "q_sxx"), 0.5 * first(table, "q_syy"), 1) << "the other has its K0";
  EXPECT_LT(first(table, "q_syy"), -5e3);
}

/// A round hole of the radius 1 m is dug in ground under sxx = -2, syy = -1 MPa.  The wall moves by (1 + nu) / E (m + d (3 - 4 nu) cos 2 theta), m and
/// d being half the sum and half the difference of the two (Kirsch 1898), in ground without end; here it ends eight radii away.
TEST_F(StartStress, NightlyAHoleInGroundUnderStressMovesAsKirschSays)
{
  constexpr int pieces = 12;
  const auto corner = [&](int i) {
    const Real angle = std::numbers::pi / 2 * i / pieces;
    return "[" + std::to_string(std::cos(angle)) + ", " + std::to_string(std::sin(angle)) + "]";
  };
  std::string outward, backward;
  for (int i = 0; i <= pieces; ++i) {
    outward += corner(i) + ", ";
    backward += corner(pieces - i) + ", ";
  }
  write(
      "hole.yaml",
      "title: Hole\ndimension: 2\nmesh:\n  size: 0.6\n  refine: [{within: {low: [0, 0], high: [2.2, 2.2]}, size: 0.22}]\n  regions:\n"
      "    - {name: core, shape: {type: polygon, points: [" +
          outward + "[0, 0]]}}\n    - {name: ground, shape: {type: polygon, points: [" + backward +
          "[8, 0], [8, 8], [0, 8]]}}\n"
          "materials: [{name: rock, law: linear_elastic, density: 2500, youngs_modulus: 1.0e9, poisson_ratio: 0.25}]\n"
          "bodies: [{name: core, material: rock, region: core, particles_per_cell: 3}, {name: ground, material: rock, region: ground, "
          "particles_per_cell: 3}]\n"
          "boundaries: [{type: roller, on: x_min}, {type: roller, on: y_min}, {type: roller, on: x_max}, {type: roller, on: y_max}]\n"
          "stages:\n  - {type: geostatic, duration: 1, residual: 1.0e-4, initial_stress: {stress: {xx: -2.0e6, yy: -1.0e6, zz: -0.75e6}}}\n"
          "  - {type: geostatic, name: dug, duration: 3, residual: 1.0e-3, vanish: [core], reset_displacement: false}\n"
          "outputs: {history: {every: 1, points: [{name: side, at: [1, 0], body: ground}, {name: crown, at: [0, 1], body: ground}]}}\n");
  const Outcome outcome = talus("run hole.yaml --out out");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(number("out", "stages[0].steps"), 20) << "rollers answer with what the stress asks for";
  const HistoryTable table = history("out");
  constexpr Real side = -1.25e-9 * (1.5e6 + 0.5e6 * 2), crown = -1.25e-9 * (1.5e6 - 0.5e6 * 2);
  EXPECT_NEAR(last(table, "side_ux"), side, 0.1 * std::abs(side));
  EXPECT_NEAR(last(table, "crown_uy"), crown, 0.1 * std::abs(side));
}

/// A bar loaded over one and a half of its periods, undamped: what swings on after a ramp of the length T is |F(f)| of the ramp's rate at the
/// frequency of the bar: |sin x / x| of a linear one and 3 |sin x / x - cos x| / x^2 of a smooth one, x = pi T / period.
TEST_F(StartStress, ASmoothRampSetsABarSwingingLess)
{
  constexpr Real period = 0.4;  // 4 L / c, L = 10 m, c = 100 m/s
  const auto swing = [&](const std::string& shape) {
    write("bar.yaml",
          "title: Bar\ndimension: 2\nmesh: {grid: {low: [0, 0], high: [10, 1], cells: [20, 2]}}\n"
          "materials: [{name: soft, law: linear_elastic, density: 1000, youngs_modulus: 1.0e7, poisson_ratio: 0}]\n"
          "bodies: [{name: bar, material: soft, region: all, particles_per_cell: 3}]\ntransfer: {pic_damping_time: 1.0e6}\n"
          "on_exit: delete\nloads: [{type: traction, on: x_max, traction: [-100, 0], carried_by: mesh}]\n"
          "boundaries: [{type: roller, on: x_min}, {type: roller, on: y_min}, {type: roller, on: y_max}]\n"
          "stages: [{type: geostatic, duration: 1.8, ramp: 0.6, residual: 1.0e-9, damping: 0, ramp_shape: " +
              shape + "}]\noutputs: {history: {every: 0.005, points: [{name: end, at: [10, 0.5]}]}}\n");
    EXPECT_EQ(talus("run bar.yaml --out " + shape).code, 1) << "nothing damps it";
    const HistoryTable table = history(shape);
    const auto time = table["time"].value(), u = table["end_ux"].value();
    Real low = std::numeric_limits<Real>::infinity(), high = -low;
    for (std::size_t row = 0; row < time.size(); ++row)
      if (time[row] > 0.6)
        low = std::min(low, u[row]), high = std::max(high, u[row]);
    return (high - low) / (high + low);  // about the displacement at rest
  };
  const Real x = std::numbers::pi * 0.6 / period;
  const Real first_mode = 8 / (std::numbers::pi * std::numbers::pi);  // of the displacement of the end
  const Real linear = std::abs(swing("linear")), smooth = std::abs(swing("smooth"));
  EXPECT_NEAR(linear, first_mode * std::abs(std::sin(x) / x), 0.04);
  EXPECT_NEAR(smooth, first_mode * 3 * std::abs(std::sin(x) / x - std::cos(x)) / (x * x), 0.02);
  EXPECT_LT(smooth, 0.5 * linear);
}

}  // namespace
}  // namespace talus::start_stress_test
