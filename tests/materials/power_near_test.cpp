// Powers found by series near a known one, against those of the standard library.
#include <gtest/gtest.h>

#include "materials/parts/power_near.hpp"

namespace talus::power_near_test {
namespace {

constexpr Real exact = 1e-13;  // what the series leave out is below 3e-14

TEST(PowerNear, IsThePowerNearAndFar)
{
  for (const Real exponent : {0.05, 0.3, 0.5, 0.99, 1.0, 2.5})
    for (const Real at : {1e-6, 0.7, 40.0}) {
      const PowerNear<Real> power(at, exponent);
      for (const Real way : {0.0, 1e-9, -9e-4, 9.9e-4, -1.1e-3, 5e-3, -0.0199, 0.0199, -0.021, 0.021, -0.0999, 0.0999, -0.5, 3.0}) {
        const Real x = at * (1 + way), expected = std::pow(x, exponent);
        EXPECT_NEAR(power(x), expected, exact * expected) << exponent << " " << at << " " << way;
      }
    }
}

TEST(PowerNear, OfFourAtOnceIsThatOfEach)
{
  constexpr Real exponent = 0.4;
  const Pack at{0.5, 0.5, 0.5, 0};
  const PowerNear<SimdReal> power(SimdReal(at), exponent);
  for (const Real way : {0.0, 5e-4, 0.01, 0.3}) {
    const Pack x{0.5, 0.5 * (1 + way), 0.5 * (1 - way), 0};
    const SimdReal found = power(SimdReal(x));
    for (int lane = 0; lane < 3; ++lane)
      EXPECT_NEAR(found.of[lane], std::pow(x[lane], exponent), exact) << way << " " << lane;
    EXPECT_EQ(found.of[3], 0) << way;
  }
}

TEST(PowerNear, GoesOnFromTheLastThatWasComputedInFull)
{
  constexpr Real exponent = 0.3;
  PowerNear<SimdReal> power(SimdReal(0.01), exponent);
  for (const Pack& x : {Pack{0.01, 0.01, 0.01, 0.01}, Pack{0.05, 0.02, 0.011, 0}, Pack{0.051, 0.0201, 0.0109, 0}, Pack{0.3, 0, 0.01, 2}}) {
    const SimdReal found = power.advance(SimdReal(x));
    for (int lane = 0; lane < pack_size; ++lane)
      EXPECT_NEAR(found[lane], std::pow(x[lane], exponent), exact) << x[lane] << " in " << lane;
  }
}

TEST(PowerNear, BeginsAtNothing)
{
  const PowerNear<Real> power(0, 0.3);
  EXPECT_EQ(power(0), 0);
  EXPECT_NEAR(power(1e-3), std::pow(1e-3, 0.3), exact);
}

}  // namespace
}  // namespace talus::power_near_test
