#include "mesh/geometry/plan_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mesh/geometry/hillshade.hpp"

namespace talus::plan_grid_test {
namespace {

const PlanGrid grid{4, 3, 10, 20, 0.5, 1};  // 2 m by 3 m

Real total(const std::vector<CellShare>& shares)
{
  Real sum = 0;
  for (const CellShare& in : shares)
    sum += in.share;
  return sum;
}

TEST(PlanGrid, SharesASquareByArea)
{
  std::vector<CellShare> shares;
  spread(grid, {10.5, 21.5}, 0.4, shares);  // across the line between the first two columns
  ASSERT_EQ(shares.size(), 2U);
  EXPECT_EQ(shares[0].cell, grid.cell(0, 1));
  EXPECT_NEAR(shares[0].share, 0.5, 1e-14);
  EXPECT_EQ(shares[1].cell, grid.cell(1, 1));
  spread(grid, {10.6, 21.1}, 0.4, shares);  // 10.4 to 10.8, 20.9 to 21.3
  ASSERT_EQ(shares.size(), 4U);
  EXPECT_NEAR(shares[0].share, 0.25 * 0.25, 1e-14);
  EXPECT_NEAR(shares[3].share, 0.75 * 0.75, 1e-14);
}

TEST(PlanGrid, LosesNothingAtTheRimNorFromLargeSquares)
{
  std::vector<CellShare> shares;
  for (const Real x : {9.0, 10.0, 10.01, 11.3, 12.0, 15.0})
    for (const Real y : {19.0, 20.0, 21.5, 23.0})
      for (const Real side : {0.01, 0.5, 1.7, 40.0}) {
        spread(grid, {x, y}, side, shares);
        EXPECT_NEAR(total(shares), 1, 1e-13) << x << " " << y << " " << side;
        for (const CellShare& in : shares)
          EXPECT_LT(in.cell, grid.size());
      }
}

TEST(PlanGrid, IsSampledLinearlyBetweenCentresThatHaveAValue)
{
  std::vector<Real> values;
  for (Index row = 0; row < grid.rows; ++row)
    for (Index column = 0; column < grid.columns; ++column) {
      const auto [x, y] = grid.centre(column, row);
      values.push_back(2 * x - 3 * y);
    }
  EXPECT_NEAR(sampled(grid, values, {11.1, 21.3}), 2 * 11.1 - 3 * 21.3, 1e-12);
  values[grid.cell(1, 1)] = std::numeric_limits<Real>::quiet_NaN();
  EXPECT_TRUE(std::isnan(sampled(grid, values, {10.8, 21.4}))) << "the nearest centre has none";
  EXPECT_FALSE(std::isnan(sampled(grid, values, {11.1, 21.5}))) << "the nearest centre has one";
}

/// z = a x + b y
Raster slope(Real a, Real b)
{
  Raster raster{.columns = 5, .rows = 4, .west = 0, .south = 0, .dx = 2, .dy = 1, .values = std::vector<Real>(20), .crs = "", .unit = "m"};
  for (Index row = 0; row < raster.rows; ++row)
    for (Index column = 0; column < raster.columns; ++column)
      raster.at(column, row) = a * (column + 0.5) * raster.dx + b * (row + 0.5) * raster.dy;
  return raster;
}

TEST(Hillshade, IsTheCosineToALightInTheNorthWest)
{
  const std::size_t inside = 5 + 2;
  const Real steep = std::sqrt(0.5);  // east and north: a fall of 45 degrees
  EXPECT_NEAR(hillshade(slope(0, 0))[inside], std::sqrt(0.5), 1e-14);
  EXPECT_NEAR(hillshade(slope(steep, -steep))[inside], 1, 1e-14) << "falls towards the light";
  EXPECT_NEAR(hillshade(slope(-steep, steep))[inside], 0, 1e-14) << "falls away from it";
  EXPECT_NEAR(hillshade(slope(steep, steep))[inside], 0.5, 1e-14) << "falls across";
}

}  // namespace
}  // namespace talus::plan_grid_test
