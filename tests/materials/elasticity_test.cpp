// Elastic constants in any pair: conversions, and what is said of pairs that make no solid.
#include "materials/parts/elasticity.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace talus::elasticity_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Problems = std::vector<std::string>;

Problems problems(const Elasticity& elastic)
{
  Problems found;
  elastic.check(found);
  return found;
}

/// Bulk and shear modulus of a solid; everything else below is worked out from them by hand.
struct Solid {
  Real K, G;
  Real E() const { return 9 * K * G / (3 * K + G); }
  Real nu() const { return (3 * K - 2 * G) / (6 * K + 2 * G); }
  Real lambda() const { return K - 2 * G / 3; }
};

/// All pairs that can be given of one solid.
std::vector<Elasticity> pairs_of(const Solid& solid)
{
  std::vector<Elasticity> pairs(5);
  pairs[0].youngs_modulus = solid.E(), pairs[0].poisson_ratio = solid.nu();
  pairs[1].bulk_modulus = solid.K, pairs[1].shear_modulus = solid.G;
  pairs[2].lame_lambda = solid.lambda(), pairs[2].shear_modulus = solid.G;
  pairs[3].youngs_modulus = solid.E(), pairs[3].bulk_modulus = solid.K;
  pairs[4].shear_modulus = solid.G, pairs[4].poisson_ratio = solid.nu();
  return pairs;
}

TEST(Elasticity, EveryPairGivesTheSameModuli)
{
  for (const Solid solid : {Solid{1e7 / 1.2, 1e7 / 2.6}, Solid{2e9, 1e6}, Solid{1e6, 2e6}, Solid{1e5, 7e5}})
    for (const Elasticity& pair : pairs_of(solid)) {
      EXPECT_THAT(problems(pair), IsEmpty());
      const Moduli m = pair.moduli();
      const Real exact = 1e-14 * (1 + solid.K / solid.G);  // Poisson's ratio near 0.5 hides K behind G
      EXPECT_NEAR(m.bulk / solid.K, 1, exact);
      EXPECT_NEAR(m.shear / solid.G, 1, exact);
      EXPECT_NEAR(m.youngs / solid.E(), 1, exact);
      EXPECT_NEAR(m.poisson, solid.nu(), exact);
      EXPECT_NEAR(m.lambda, solid.lambda(), exact * solid.K);
      EXPECT_NEAR(m.confined(), solid.K + 4 * solid.G / 3, exact * solid.K);
    }
}

TEST(Elasticity, KnownSteel)
{
  const Moduli m = elasticity(210e9, 0.3).moduli();
  EXPECT_NEAR(m.bulk, 175e9, 1e-14 * 175e9);
  EXPECT_NEAR(m.shear, 210e9 / 2.6, 1e-14 * 210e9);
  EXPECT_NEAR(m.lambda, 63e9 / 0.52, 1e-14 * 210e9);
  EXPECT_EQ(m.youngs, 210e9);
  EXPECT_EQ(m.poisson, 0.3);
}

TEST(Elasticity, WithoutAPairThereAreNoModuli)
{
  Elasticity alone;
  alone.youngs_modulus = 1e7;
  EXPECT_TRUE(std::isnan(alone.moduli().bulk));
  EXPECT_TRUE(std::isnan(Elasticity{}.moduli().shear));
}

constexpr std::string_view one_pair =
    "elastic constants come as one pair: youngs_modulus and poisson_ratio, bulk_modulus and shear_modulus, lame_lambda and shear_modulus, "
    "youngs_modulus and bulk_modulus, or shear_modulus and poisson_ratio; here ";

TEST(ElasticityRules, AnythingButOneKnownPairIsToldInWords)
{
  Elasticity elastic;
  EXPECT_THAT(problems(elastic), ElementsAre(fmt::format("{}{}", one_pair, "there is none")));
  elastic.shear_modulus = 1e7;
  EXPECT_THAT(problems(elastic), ElementsAre(fmt::format("{}{}", one_pair, "there is shear_modulus alone")));
  elastic.youngs_modulus = 1e7;
  EXPECT_THAT(problems(elastic), ElementsAre(fmt::format("{}{}", one_pair, "there are youngs_modulus, shear_modulus")));
  elastic.poisson_ratio = 0.3;
  EXPECT_THAT(problems(elastic), ElementsAre(fmt::format("{}{}", one_pair, "there are youngs_modulus, poisson_ratio, shear_modulus")));
}

TEST(ElasticityRules, UnstablePairsAreToldWithTheirPoissonRatio)
{
  Elasticity stretchy, squashy;
  stretchy.shear_modulus = 1e6;
  stretchy.lame_lambda = -0.9e6;
  EXPECT_THAT(problems(stretchy),
              ElementsAre("shear_modulus 1e+06 and lame_lambda -900000 make Poisson's ratio -4.5, which must lie in (-1, 0.5)"));
  stretchy.lame_lambda = -0.6e6;
  EXPECT_THAT(problems(stretchy), IsEmpty());
  squashy.youngs_modulus = 9.5e6, squashy.bulk_modulus = 1e6;
  EXPECT_THAT(problems(squashy),
              ElementsAre("youngs_modulus 9.5e+06 and bulk_modulus 1e+06 make Poisson's ratio -1.08333, which must lie in (-1, 0.5)"));
  squashy.youngs_modulus = 9e6;  // the shear modulus grows beyond bounds
  EXPECT_THAT(problems(squashy),
              ElementsAre("youngs_modulus 9e+06 and bulk_modulus 1e+06 make Poisson's ratio -1, which must lie in (-1, 0.5)"));
  squashy.youngs_modulus = 8.5e6;
  EXPECT_THAT(problems(squashy), IsEmpty());
}

}  // namespace
}  // namespace talus::elasticity_test
