#include <gtest/gtest.h>

#include "tests/materials/samples.hpp"

namespace talus::maxwell_test {

TEST(Maxwell, ShearStressFallsByOneEInTheRelaxationTime)
{
  testing::Point<Maxwell> point{.law = testing::sample<Maxwell>()};
  constexpr int steps = 1000;
  const Real dt = point.law.relaxation_time / steps;
  Mat3 shear = Mat3::Identity();
  shear(0, 1) = 1e-6;
  point.step(shear, true, dt);
  const Real start = point.stress(0, 1);
  for (int i = 0; i < steps; ++i)
    point.step(Mat3::Identity(), false, dt);
  EXPECT_NEAR(point.stress(0, 1), start * std::exp(-1), start / steps);  // backward Euler is of first order: half of 1/e per step
  EXPECT_NEAR(point.stress.trace(), 0, 1e-12 * point.constants.bulk);
}

}  // namespace talus::maxwell_test
