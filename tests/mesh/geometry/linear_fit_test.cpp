// Planes through scattered points: exact for linear functions, the same whatever the order of the search.
#include "mesh/geometry/linear_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace talus::linear_fit_test {
namespace {

template <int D>
std::vector<Vec<D>> scattered(int n, Real stretch = 1)
{
  std::mt19937 random(7);
  std::vector<Vec<D>> points;
  for (int i = 0; i < n; ++i) {
    Vec<D> x;
    for (int d = 0; d < D; ++d)
      x[d] = static_cast<Real>(random()) / 4294967296.0;
    x[0] *= stretch;
    points.push_back(x);
  }
  return points;
}

template <int D>
Real linear(const Vec<D>& x)
{
  return -3 + 7 * x[0] - 2 * x[D - 1];
}

template <int D>
void expect_exact(Real stretch)
{
  const PointCloud<D> cloud(scattered<D>(300, stretch));  // beside a narrow one, the digits of its width count
  for (const Vec<D>& x : {Vec<D>(Vec<D>::Constant(0.4)), Vec<D>(Vec<D>::Constant(0)), Vec<D>(Vec<D>::Constant(-0.1)), cloud[17]}) {
    const auto fit = cloud.fit(x);
    ASSERT_TRUE(fit.has_value());
    EXPECT_NEAR(fit->at([&](Index i) { return linear<D>(cloud[i]); }), linear<D>(x), 2e-11 / stretch) << x.transpose();
    Vec<D> slope = Vec<D>::Zero();
    for (std::size_t k = 0; k < fit->point.size(); ++k)
      slope += linear<D>(cloud[fit->point[k]]) * fit->slope[k];
    EXPECT_NEAR(slope[0], 7, 1e-9);
    EXPECT_NEAR(slope[D - 1], -2, 1e-9 * (1 + stretch));
  }
}

TEST(LinearFit, IsExactForLinearFunctionsAlsoBesideThePoints)
{
  expect_exact<2>(1);
  expect_exact<3>(1);
}

TEST(LinearFit, LooksFartherWherePointsAreDenseAlongOneAxis)
{
  expect_exact<2>(0.002);
  expect_exact<3>(0.01);
}

TEST(LinearFit, TakesTheValueOfAPointBesideItAlmostWhole)
{
  const PointCloud<2> cloud(scattered<2>(300));
  const auto fit = cloud.fit(cloud[40]);
  ASSERT_TRUE(fit.has_value());
  EXPECT_EQ(fit->nearest, 40);
  EXPECT_EQ(fit->distance, 0);
  const Real self = fit->at([](Index i) { return i == 40 ? 1.0 : 0.0; });
  EXPECT_GT(self, 0.75);
  EXPECT_LT(self, 1);
}

/// What cannot be negative stays so, although a plane goes on.
TEST(LinearFit, GivesValuesWithinThoseOfItsPointsWhereAsked)
{
  const PointCloud<2> cloud(scattered<2>(300));
  const Vec<2> beside(-0.1, 0.5), amidst(0.5, 0.5);
  const auto strain = [&](Index i) { return std::max(cloud[i][0] - 0.05, Real{0}); };
  ASSERT_LT(cloud.fit(beside)->at([&](Index i) { return cloud[i][0]; }), 0);
  EXPECT_GE(cloud.fit(beside)->at_within([&](Index i) { return cloud[i][0]; }), 0);
  EXPECT_GE(cloud.fit(beside)->at_within(strain), 0);
  EXPECT_EQ(cloud.fit(amidst)->at_within(strain), cloud.fit(amidst)->at(strain));
}

TEST(LinearFit, HasNoPlaneWhereThePointsLieOnALine)
{
  std::vector<Vec<2>> line;
  std::vector<Vec<3>> plane;
  for (int i = 0; i < 40; ++i) {
    line.emplace_back(0.1 * i, 0.3 * i + 1);
    plane.emplace_back(0.1 * i, 0.1 * ((7 * i) % 11), 2);
  }
  EXPECT_FALSE(PointCloud<2>(line).fit({1, 2}).has_value());
  EXPECT_FALSE(PointCloud<3>(plane).fit({1, 0.5, 2}).has_value());
  plane.emplace_back(1, 0.5, 3);
  EXPECT_TRUE(PointCloud<3>(plane).fit({1, 0.5, 2}).has_value());
  EXPECT_FALSE(PointCloud<2>({{0, 0}, {1, 0}}).fit({0, 0}).has_value());
  EXPECT_TRUE(PointCloud<2>({{0, 0}, {1, 0}, {0, 1}}).fit({5, 5}).has_value());
}

TEST(LinearFit, FindsTheNearestInTheOrderOfDistanceAndNumber)
{
  std::vector<Vec<2>> points;
  for (int i = 0; i < 100; ++i)
    points.emplace_back(i % 10, i / 10);
  const PointCloud<2> cloud(points);
  const Vec<2> x(4.5, 4.5);
  std::vector<std::pair<Real, Index>> all;
  for (Index i = 0; i < 100; ++i)
    all.emplace_back((points[static_cast<std::size_t>(i)] - x).squaredNorm(), i);
  std::sort(all.begin(), all.end());
  all.resize(17);
  EXPECT_EQ(cloud.nearest(x, 17), all);
  EXPECT_EQ(cloud.nearest(x, 1000).size(), 100U);
}

}  // namespace
}  // namespace talus::linear_fit_test
