// Factors of parameters that vary: mean, deviation and correlation over many seeds.
#include "materials/variation/parameter_variation.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace talus::parameter_variation_test {
namespace {

constexpr int seeds = 2000;
constexpr Real bound = 4;  // of the standard error

ParameterVariation entry(Distribution distribution, Real deviation, const std::string& parameter = "cohesion")
{
  ParameterVariation one;
  one.parameter = parameter;
  one.distribution = distribution;
  one.coefficient_of_variation = deviation;
  one.correlation_length = {4};
  return one;
}

/// The factors at a place for many seeds.
template <std::size_t N>
std::vector<std::array<Real, N>> factors_of(std::array<ParameterVariation, N> list)
{
  std::vector<std::array<Real, N>> all(seeds);
  for (int seed = 0; seed < seeds; ++seed) {
    for (ParameterVariation& one : list)
      one.seed = seed;
    VariationFields{list}(Vec3(1, 2, 3), all[static_cast<std::size_t>(seed)]);
  }
  return all;
}

TEST(Factors, HaveMeanOneAndTheirCoefficientOfVariation)
{
  for (const Distribution distribution : {Distribution::lognormal, Distribution::normal})
    for (const Real v : {0.1, 0.5}) {
      Real mean = 0, square = 0, least = HUGE_VAL;
      for (const auto& [factor] : factors_of<1>({entry(distribution, v)}))
        mean += factor / seeds, square += factor * factor / seeds, least = std::min(least, factor);
      const Real deviation = std::sqrt(square - mean * mean);
      // Kurtosis of a lognormal variable with w = 1 + v^2: w^4 + 2 w^3 + 3 w^2 - 3.
      const Real w = 1 + v * v, kurtosis = distribution == Distribution::normal ? 3 : w * w * w * w + 2 * w * w * w + 3 * w * w - 3;
      EXPECT_NEAR(mean, 1, bound * v / std::sqrt(Real{seeds}));
      EXPECT_NEAR(deviation, v, bound * v * std::sqrt((kurtosis - 1) / (4 * seeds)));
      if (distribution == Distribution::lognormal) {
        EXPECT_GT(least, 0);
      }
    }
}

TEST(Factors, AreCorrelatedAsTheListSays)
{
  for (const Real wanted : {-0.5, 0.8, 1.0}) {
    std::array<ParameterVariation, 2> list{entry(Distribution::lognormal, 0.3), entry(Distribution::normal, 0.2, "friction_angle")};
    list[1].correlated_with = "cohesion";
    list[1].correlation = wanted;
    Real product = 0;
    const Real s = std::sqrt(std::log1p(0.3 * 0.3));
    for (const auto& [c, phi] : factors_of<2>(list))
      product += (std::log(c) / s + s / 2) * ((phi - 1) / 0.2) / seeds;
    EXPECT_NEAR(product, wanted, bound * std::sqrt((1 + wanted * wanted) / seeds));
  }
}

TEST(Factors, WithoutDeviationAreOne)
{
  std::array<Real, 1> factor{};
  VariationFields{std::array{entry(Distribution::lognormal, 0)}}(Vec3(1, 2, 3), factor);
  EXPECT_EQ(factor[0], 1);
}

TEST(ParameterVariation, IsTheSameWhereverItStandsInAFile)
{
  ParameterVariation one = entry(Distribution::normal, 0.2), other = one;
  other.where = {"scene.yaml", 3, 4, ""};
  EXPECT_EQ(one, other);
  other.seed = 2;
  EXPECT_NE(one, other);
  other = one, other.minimum = 3;
  EXPECT_NE(one, other);
}

TEST(ParameterVariation, SaysWhatIsMissing)
{
  const auto problems = [](auto&& change) {
    ParameterVariation one = entry(Distribution::normal, 0.2);
    change(one);
    std::vector<std::string> all;
    one.check(all);
    return all.size();
  };
  EXPECT_EQ(problems([](auto&) {}), 0U);
  EXPECT_EQ(problems([](auto& one) { one.correlation_length.clear(); }), 1U);
  EXPECT_EQ(problems([](auto& one) { one.coefficient_of_variation = 0; }), 1U);
  EXPECT_EQ(problems([](auto& one) { one.coefficient_of_variation = 0, one.trend = "1 + y", one.correlation_length.clear(); }), 0U);
  EXPECT_EQ(problems([](auto& one) { one.correlation = 0.5; }), 1U);
  EXPECT_EQ(problems([](auto& one) { one.minimum = 5, one.maximum = 5; }), 1U);
}

}  // namespace
}  // namespace talus::parameter_variation_test
