// Stages that solve for equilibrium.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/app/program.hpp"

namespace talus::static_stage_test {
namespace {

using StaticStage = Program;

/// A soft column of 1 m by 6 m between rollers, on a mesh that does not follow its top.
std::string column(const std::string& stages, const std::string& rest = "")
{
  return R"(title: Column
dimension: 2
mesh: {grid: {low: [0, 0], high: [1, 8], cells: [2, 16]}}
materials: [{name: soft, law: hencky, density: 1000, youngs_modulus: 5.0e5, poisson_ratio: 0}]
bodies: [{name: column, material: soft, shape: {type: box, low: [0, 0], high: [1, 6.2]}, particles_per_cell: 6}]
loads: [{type: gravity, acceleration: [0, -10]}]
boundaries: [{type: fixed, on: y_min}, {type: roller, on: x_min}, {type: roller, on: x_max}]
stages:
)" + stages +
         "outputs: {history: {every: 1.0e-9, points: [{name: top, at: [0.5, 6.2]}]}, particles: {every: 1}" + rest + "}\n";
}

/// The settlement of the top of a column of that height under its weight where sigma = M ln F / F (nu = 0): F = exp(-W(p / M)).
Real settlement(Real height, Real weight, Real modulus)
{
  constexpr int n = 10000;
  Real sum = 0;
  for (int i = 0; i < n; ++i) {
    const Real p = weight * height * (i + 0.5) / n;
    Real F = 1;  // sigma F = M ln F with sigma = -p
    for (int k = 0; k < 50; ++k)
      F = std::exp(-p * F / modulus);
    sum += (1 - F) * height / n;
  }
  return sum;
}

TEST_F(StaticStage, FindsTheColumnUnderItsWeight)
{
  write("column.yaml", column("  - {type: static, increments: 4}\n"));
  const Outcome run = talus("run column.yaml --out run");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NEAR(-last(history("run"), "top_uy"), settlement(6.2, 1e4, 5e5), 0.02 * settlement(6.2, 1e4, 5e5));
  EXPECT_LT(last(history("run"), "unbalanced"), 2e-4);
  EXPECT_LT(last(history("run"), "kinetic"), 1e-20);
}

TEST_F(StaticStage, StaysAtRestInTheStageBehindIt)
{
  write("column.yaml", column("  - {type: static, increments: 4}\n  - {type: run, duration: 0.3}\n"));
  const Outcome run = talus("run column.yaml --out run");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_LT(last(history("run"), "kinetic"), 1e-6 * 1e4 * 6.2 * settlement(6.2, 1e4, 5e5));
}

}  // namespace
}  // namespace talus::static_stage_test
