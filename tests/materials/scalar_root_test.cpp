#include "materials/parts/scalar_root.hpp"

#include <gtest/gtest.h>

namespace talus::scalar_root_test {
namespace {

/// r - x - b x^n, which falls infinitely steeply at zero, and how often it was asked.
struct PowerFall {
  Real r, b, n;
  int asked = 0;
  ValueAndSlope operator()(Real x)
  {
    ++asked;
    return {r - x - b * std::pow(x, n), -1 - n * b * std::pow(x, n - 1)};
  }
};

TEST(PositiveRoot, IsFoundToRoundingOverTwoHundredOrdersOfMagnitude)
{
  for (const Real n : {0.05, 0.26, 0.5, 1.0})
    for (const Real b : {1e-8, 1.0, 1e8})
      for (Real root = 1e-200; root < 1e3; root *= 1e7) {
        PowerFall f{root + b * std::pow(root, n), b, n};
        const Real x = positive_root(f, f.r, 0.5 * f.r);
        // The error is that of r, one rounding, by the slope of the logarithms.
        ASSERT_NEAR(x / root, 1, 1e-15 / n + 1e-12) << n << " " << b << " " << root;
        ASSERT_LE(f.asked, 30) << n << " " << b << " " << root;
      }
}

TEST(PositiveRoot, TakesThreeLooksFromAGoodGuess)
{
  PowerFall f{2, 1, 0.5};
  EXPECT_NEAR(positive_root(f, 2, 1.001), 1, 1e-12);
  EXPECT_LE(f.asked, 3);
}

TEST(PositiveRoot, SurvivesKinksAndGuessesOutside)
{
  const auto kinked = [](Real x) { return x < 1 ? ValueAndSlope{2 - x, -1} : ValueAndSlope{1 - 100 * (x - 1), -100}; };
  for (const Real guess : {-1.0, 0.0, 1e-9, 0.5, 1.5, 3.0, 7.0, std::nan("")})
    EXPECT_NEAR(positive_root(kinked, 3, guess), 1.01, 1e-12) << guess;
}

TEST(PositiveRoot, MayBeTheUpperEnd)
{
  for (const Real high : {1e-30, 0.1, 1.0 / 3, 7e20}) {
    const auto line = [&](Real x) { return ValueAndSlope{3.3 * (high - x), -3.3}; };
    EXPECT_NEAR(positive_root(line, high, 0.3 * high) / high, 1, 1e-15);
  }
}

TEST(PositiveRoot, EndsWhereRoundingHidesTheSign)
{
  int asked = 0;
  const auto above = [&](Real x) {  // what is left at the upper end is rounding, of the wrong sign
    ++asked;
    return ValueAndSlope{1 - x + 1e-16, -1.0};
  };
  EXPECT_NEAR(positive_root(above, 1, 0.3), 1, 1e-14);
  EXPECT_LE(asked, 20);
}

}  // namespace
}  // namespace talus::scalar_root_test
