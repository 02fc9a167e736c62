// Seeding points: equal shares, strictly inside, symmetric, exact as far as stated and no further.
#include "mesh/quadrature.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace talus::quadrature_test {
namespace {

Real factorial(int n) { return n < 2 ? 1 : n * factorial(n - 1); }

/// Largest error of the mean of a monomial of barycentric coordinates, over all of this degree.  Exact: prod(p!) D! / (D + sum p)!.
template <int D>
Real error_of_degree(const std::vector<std::array<Real, D + 1>>& points, int degree)
{
  Real worst = 0;
  std::array<int, D + 1> power{};
  const auto check = [&] {
    Real mean = 0, exact = factorial(D) / factorial(D + degree);
    for (const auto& lambda : points) {
      Real product = 1;
      for (int a = 0; a <= D; ++a)
        product *= std::pow(lambda[a], power[a]);
      mean += product / static_cast<Real>(points.size());
    }
    for (const int p : power)
      exact *= factorial(p);
    worst = std::max(worst, std::abs(mean - exact));
  };
  const auto each = [&](auto&& self, int a, int left) -> void {
    if (a == D) {
      power[D] = left;
      check();
      return;
    }
    for (power[a] = 0; power[a] <= left; ++power[a])
      self(self, a + 1, left - power[a]);
  };
  each(each, 0, degree);
  return worst;
}

template <int D>
void expect_fair_points()
{
  for (const int n : seeding_counts<D>()) {
    const auto points = *seeding_points<D>(n);
    ASSERT_EQ(points.size(), static_cast<std::size_t>(n));
    for (const auto& lambda : points) {
      Real sum = 0;
      for (const Real l : lambda) {
        EXPECT_GT(l, 0.1 / n) << n;  // strictly inside
        sum += l;
      }
      EXPECT_NEAR(sum, 1, 1e-15);
    }
    EXPECT_LT(error_of_degree<D>(points, 1), 1e-15) << n;  // the centroid
    if (n > 1)
      EXPECT_LT(error_of_degree<D>(points, 2), 1e-15) << n;
    else
      EXPECT_GT(error_of_degree<D>(points, 2), 1e-3);
  }
}

TEST(SeedingPoints, AreFairInTriangles) { expect_fair_points<2>(); }
TEST(SeedingPoints, AreFairInTetrahedra) { expect_fair_points<3>(); }

TEST(SeedingPoints, AreExactForCubicsWhereStatedAndOnlyThere)
{
  for (const int n : seeding_counts<2>()) {
    const bool cubic = n == 6 || n == 24 || n == 54 || n == 96;
    EXPECT_EQ(error_of_degree<2>(*seeding_points<2>(n), 3) < 1e-15, cubic) << n;
  }
  for (const int n : seeding_counts<3>())
    EXPECT_EQ(error_of_degree<3>(*seeding_points<3>(n), 3) < 1e-15, n == 10) << n;
}

template <int D>
void expect_symmetry()
{
  for (const int n : seeding_counts<D>()) {
    const auto rounded = [](std::array<Real, D + 1> lambda, int a, int b) {
      std::swap(lambda[a], lambda[b]);
      std::array<long, D + 1> digits{};
      for (int i = 0; i <= D; ++i)
        digits[i] = std::lround(lambda[i] * 1e10);
      return digits;
    };
    const auto points = *seeding_points<D>(n);
    for (int a = 0; a <= D; ++a)
      for (int b = a + 1; b <= D; ++b) {
        std::set<std::array<long, D + 1>> here, mirrored;
        for (const auto& lambda : points) {
          here.insert(rounded(lambda, a, a));
          mirrored.insert(rounded(lambda, a, b));
        }
        EXPECT_EQ(here.size(), points.size());  // no two at one place
        EXPECT_EQ(here, mirrored) << n;
      }
  }
}

TEST(SeedingPoints, AreSymmetricInTriangles) { expect_symmetry<2>(); }
TEST(SeedingPoints, AreSymmetricInTetrahedra) { expect_symmetry<3>(); }

TEST(SeedingPoints, CountsAreThoseOfTheDocumentation)
{
  EXPECT_THAT(seeding_counts<3>(), ::testing::ElementsAre(1, 4, 8, 10, 14, 20, 35, 56));
  EXPECT_THAT(seeding_counts<2>(), ::testing::ElementsAre(1, 3, 4, 6, 9, 12, 16, 24, 25, 27, 36, 48, 49, 54, 64, 75, 81, 96, 100));
}

TEST(SeedingPoints, OtherCountsHaveNone)
{
  for (const int n : {-1, 0, 2, 5, 7, 13, 101, 1 << 30})
    EXPECT_FALSE(seeding_points<2>(n)) << n;
  for (const int n : {-4, 0, 2, 3, 6, 9, 57})
    EXPECT_FALSE(seeding_points<3>(n)) << n;
}

}  // namespace
}  // namespace talus::quadrature_test
