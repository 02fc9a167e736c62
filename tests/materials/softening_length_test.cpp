// Strength that follows an averaged plastic strain.
#include <gtest/gtest.h>

#include "materials/interface/law_variant.hpp"
#include "tests/materials/soil.hpp"

namespace talus::softening_length_test {
namespace {

using testing::Point;

DruckerPrager cone()
{
  DruckerPrager law = testing::soft_soil(ConeMatch::plane_strain, 0, 10e3);
  law.residual_cohesion = 2e3;
  law.softening_strain = 0.1;
  law.softening_length = 0.3;
  return law;
}
MohrCoulomb planes()
{
  MohrCoulomb law;
  static_cast<Elasticity&>(law) = cone();
  static_cast<SoilStrength&>(law) = cone();
  law.density = 2000;
  return law;
}

/// Simple shear by `steps` of 0.001.
template <class L>
void shear(Point<L>& point, int steps)
{
  Mat3 f = Mat3::Identity();
  f(0, 1) = 1e-3;
  for (int n = 0; n < steps; ++n)
    point.step(f);
}

/// The shear strength follows the mean alone: it neither falls with the plastic strain of the particle nor during a step.
template <class L>
void follows_the_mean(const L& law)
{
  Point<WithSofteningLength<L>> point{.law = {law}};
  const auto strength = [&](Real k) { return 10e3 - (10e3 - 2e3) * std::min(k / 0.1, Real{1}); };
  shear(point, 40);
  ASSERT_GT(point.state.plastic_strain, 0.01);
  EXPECT_EQ(point.state.mean_plastic_strain, 0);
  EXPECT_NEAR(point.stress(0, 1), strength(0), 5);  // simple shear turns the stress a little
  for (const Real k : {0.02, 0.05, 0.2}) {
    point.state.mean_plastic_strain = (point.state.plastic_strain + k) / 2;
    Mat3 f = Mat3::Identity();
    f(0, 1) = 1e-5;
    point.step(f);
    EXPECT_NEAR(point.stress(0, 1), strength(k), 5);
    point.state.mean_plastic_strain = (point.state.plastic_strain + k) / 2;  // k as it was in the step
    EXPECT_NEAR(point.law.yield(point.stress, point.state), 0, 2);
  }
  EXPECT_GT(point.state.plastic_work, 0);

  // Flow that goes on at the residual strength does not bring the peak back: the mean saturates, and so must the strain.
  for (const Real strain : {0.3, 0.5, 3.0}) {
    point.state.plastic_strain = strain;
    point.state.mean_plastic_strain = point.law.largest_averaged();
    Mat3 f = Mat3::Identity();
    f(0, 1) = 1e-5;
    point.step(f);
    EXPECT_NEAR(point.stress(0, 1), 2e3, 5) << strain;
    EXPECT_NEAR(point.law.yield(point.stress, point.state), 0, 2);
  }
}
TEST(SofteningLength, LetsTheConeFollowTheMean) { follows_the_mean(cone()); }
TEST(SofteningLength, LetsThePlanesFollowTheMean) { follows_the_mean(planes()); }

/// Undrained clay of a shear strength of 10 kPa, 2 kPa after softening.
VonMises metal()
{
  VonMises law;
  static_cast<Elasticity&>(law) = cone();
  law.density = 2000;
  law.yield_stress = std::sqrt(3.0) * 10e3;
  law.residual_stress = std::sqrt(3.0) * 2e3;
  law.softening_strain = 0.1;
  return law;
}
TEST(SofteningLength, LetsVonMisesFollowTheMean)
{
  VonMises law = metal();
  law.softening_length = 0.3;
  follows_the_mean(law);
}

TEST(VonMises, FallsLinearlyToItsResidualStress)
{
  for (const bool hardens : {false, true}) {
    VonMises law = metal();
    if (hardens)
      law.voce = VoceHardening{.saturation = 2e3, .exponent = 30};
    Point<VonMises> point{.law = law};
    for (int n = 0; n < 60; ++n) {
      shear(point, 5);
      const Real p = point.state.plastic_strain, gained = hardens ? 2e3 * (1 - std::exp(-30 * p)) : 0;
      if (p > 0) {
        const Real left = (law.yield_stress - *law.residual_stress) * std::max(0.0, 1 - p / 0.1);
        EXPECT_NEAR(von_mises(point.stress), *law.residual_stress + left + gained, 1e-6);
      }
    }
    EXPECT_GT(point.state.plastic_strain, 0.12);
  }
}

TEST(VonMises, RefusesSofteningThatCannotBeFollowed)
{
  using testing::problems_of;
  EXPECT_EQ(problems_of(metal(), [](VonMises& law) { law.softening_strain = 1e-3; }).size(), 1U);
  EXPECT_EQ(problems_of(metal(), [](VonMises& law) { law.softening_strain = 1e-3, law.softening_length = 1; }).size(), 0U);
  EXPECT_EQ(problems_of(metal(), [](VonMises& law) { law.residual_stress = 1e6; }).size(), 1U);
  EXPECT_EQ(problems_of(metal(), [](VonMises& law) { law.residual_stress.reset(); }).size(), 1U);
  EXPECT_EQ(problems_of(metal(), [](VonMises& law) { law.softening_strain.reset(); }).size(), 1U);
}

TEST(SofteningLength, DecidesWhichHistoryThereIs)
{
  const auto width = [](DruckerPrager law) { return constitutive_law(law)->description().history_width; };
  DruckerPrager without = cone();
  without.softening_length.reset();
  EXPECT_EQ(width(without), 9);
  EXPECT_EQ(width(cone()), 11);
  EXPECT_EQ(AnyLaw(without).description().history_width, 11);
  EXPECT_FALSE(constitutive_law(without)->strain_averaging());
  const auto averaging = constitutive_law(cone())->strain_averaging();
  ASSERT_TRUE(averaging);
  EXPECT_NEAR(averaging->length, 0.4, 1e-15);
  EXPECT_NEAR(averaging->largest, 0.1 * (1 + std::sqrt(2.0)), 1e-15);
  EXPECT_EQ(averaging->strain, 6);
  EXPECT_EQ(averaging->mean, 9);
  EXPECT_EQ(averaging->rate, 10);
}

TEST(SofteningLength, NeedsSoftening)
{
  const testing::Problems found = testing::problems_of(cone(), [](DruckerPrager& law) {
    law.softening_strain.reset();
    law.residual_cohesion.reset();
  });
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0], "softening_length needs softening_strain");
}

}  // namespace
}  // namespace talus::softening_length_test
