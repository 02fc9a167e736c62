// Ramps begin at nothing, end at all, and say how.
#include "core/time_table.hpp"

#include <gtest/gtest.h>

namespace talus::ramp_test {

namespace {

TEST(Ramp, BothGrowFromNothingToAllAndPassTheHalfInTheMiddle)
{
  for (const RampShape shape : {RampShape::linear, RampShape::smooth}) {
    EXPECT_EQ(ramp_at(shape, -1), 0);
    EXPECT_EQ(ramp_at(shape, 0), 0);
    EXPECT_DOUBLE_EQ(ramp_at(shape, 0.5), 0.5);
    EXPECT_EQ(ramp_at(shape, 1), 1);
    EXPECT_EQ(ramp_at(shape, 7), 1);
    for (int i = 0; i < 100; ++i)
      EXPECT_LT(ramp_at(shape, 0.01 * i), ramp_at(shape, 0.01 * (i + 1)));
  }
}

TEST(Ramp, TheLinearOneIsTheShareOfTheTimeItself)
{
  for (const Real s : {0.1, 0.3, 1.0 / 3, 0.77})
    EXPECT_EQ(ramp_at(RampShape::linear, s), s);
}

TEST(Ramp, TheSmoothOneBeginsAndEndsWithTheRateZero)
{
  constexpr Real h = 1e-6;
  EXPECT_LT(ramp_at(RampShape::smooth, h) / h, 1e-5);
  EXPECT_LT((1 - ramp_at(RampShape::smooth, 1 - h)) / h, 1e-5);
  EXPECT_NEAR((ramp_at(RampShape::smooth, 0.5 + h) - ramp_at(RampShape::smooth, 0.5 - h)) / (2 * h), 1.5, 1e-9) << "steepest";
}

}  // namespace

}  // namespace talus::ramp_test
