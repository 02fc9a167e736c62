// Random fields against their mean, variance, covariance and distribution over many seeds.
#include "materials/variation/random_field.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace talus::random_field_test {
namespace {

constexpr int seeds = 2000;
/// Of the standard error: one estimate in 16000 is farther off by chance; the seeds do not change.
constexpr Real bound = 4;

const Vec3 lengths(8, 2, 3), origin(17, -5, 2);

std::vector<Vec3> distances()
{
  return {{0.5, 0, 0}, {2, 0, 0}, {0, 0.5, 0}, {0, 1, 0}, {0, 0, 1}, {2, 0.5, 0}, {-2, 0.5, 0.4}, {8, 2, 0}, {60, 40, 0}};
}

class Field : public ::testing::TestWithParam<Covariance> {};

TEST_P(Field, HasMeanVarianceAndCovarianceOverSeeds)
{
  const auto far = distances();
  Real mean = 0, square = 0, fourth = 0, at_zero = 0, square_at_zero = 0;
  int outside = 0;
  std::vector<Real> product(far.size(), 0);
  for (int seed = 0; seed < seeds; ++seed) {
    const RandomField field(GetParam(), lengths, static_cast<std::uint64_t>(seed), "cohesion");
    const Real here = field(origin);
    mean += here / seeds, square += here * here / seeds, fourth += here * here * here * here / seeds;
    const Real there = field(Vec3::Zero());  // where waves without phases would all be at their crest
    at_zero += there / seeds, square_at_zero += there * there / seeds;
    outside += std::abs(here) > 1.959964 ? 1 : 0;
    for (std::size_t i = 0; i < far.size(); ++i)
      product[i] += here * field(origin + far[i]) / seeds;
  }
  const Real error = 1 / std::sqrt(Real{seeds});
  EXPECT_NEAR(mean, 0, bound * error);
  EXPECT_NEAR(square, 1, bound * error * std::sqrt(Real{2}));
  EXPECT_NEAR(at_zero, 0, bound * error);
  EXPECT_NEAR(square_at_zero, 1, bound * error * std::sqrt(Real{2}));
  EXPECT_NEAR(fourth, 3, bound * error * std::sqrt(Real{96}));  // variance of the fourth power of a Gaussian variable
  EXPECT_NEAR(outside / Real{seeds}, 0.05, bound * error * std::sqrt(0.05 * 0.95));
  for (std::size_t i = 0; i < far.size(); ++i) {
    const Real expected = RandomField::correlation(GetParam(), lengths, far[i]);
    EXPECT_NEAR(product[i], expected, bound * error * std::sqrt(1 + expected * expected)) << far[i].transpose();
  }
}

TEST_P(Field, HasTheCorrelationLengthAsIntegralOfItsCorrelation)
{
  for (int d = 0; d < 3; ++d) {
    Real integral = 0;
    constexpr Real step = 1e-3;
    for (Real r = step / 2; r < 20; r += step)
      integral += 2 * step * lengths[d] * RandomField::correlation(GetParam(), lengths, r * lengths[d] * Vec3::Unit(d));
    EXPECT_NEAR(integral, lengths[d], 1e-5 * lengths[d]);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, Field, ::testing::Values(Covariance::exponential, Covariance::gaussian, Covariance::separable_exponential),
                         [](const auto& of) { return std::string(enum_names(of.param)[static_cast<std::size_t>(of.param)]); });

TEST(RandomField, IsAnotherForAnotherSeedOrStream)
{
  Real of_seeds = 0, of_streams = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    const auto number = static_cast<std::uint64_t>(seed);
    const Real here = RandomField(Covariance::gaussian, lengths, number, "cohesion")(origin);
    of_seeds += here * RandomField(Covariance::gaussian, lengths, number + 1, "cohesion")(origin) / seeds;
    of_streams += here * RandomField(Covariance::gaussian, lengths, number, "friction_angle")(origin) / seeds;
  }
  const Real error = 1 / std::sqrt(Real{seeds});
  EXPECT_NEAR(of_seeds, 0, bound * error);
  EXPECT_NEAR(of_streams, 0, bound * error);
}

/// std::mt19937_64 is the same everywhere; logarithm and cosine may differ in their last digit.
TEST(RandomField, HasTheSameValuesOnAllMachines)
{
  const Vec3 x(3, 4, 0);
  EXPECT_NEAR(RandomField(Covariance::exponential, lengths, 7, "cohesion")(x), 0.519405602455, 1e-9);
  EXPECT_NEAR(RandomField(Covariance::gaussian, lengths, 7, "cohesion")(x), 0.504741049463, 1e-9);
  EXPECT_NEAR(RandomField(Covariance::separable_exponential, lengths, 7, "cohesion")(x), 0.204329828253, 1e-9);
}

}  // namespace
}  // namespace talus::random_field_test
