// Divided strength against Mohr's circle: on every plane c + s tan(phi) must fall to its F-th part, whatever cone stands for the planes.
#include "materials/parts/strength.hpp"

#include <gtest/gtest.h>

#include "materials/interface/constitutive_law_of.hpp"
#include "tests/materials/soil.hpp"

namespace talus::strength_test {
namespace {

using testing::radians;

constexpr Real cohesion = 12e3, friction = 25, digits = 1e-12;

/// Principal stresses, tension positive, whose circle touches the line of strength (c + s tan(phi)) / F where s is the normal stress.
struct Circle {
  Real centre, radius;
  Circle(Real normal, Real factor)
  {
    const Real slope = std::tan(radians(friction)) / factor, shear = cohesion / factor + normal * slope;
    centre = -(normal + shear * slope);
    radius = shear * std::sqrt(1 + slope * slope);
  }
};

/// Excess over the yield surface, over the size of the stress: so stiff that the elastic strain is that of small strain.
template <class L>
Real excess(L law, const Vec3& principal)
{
  typename L::State state{};
  const Mat3 stress = principal.asDiagonal();
  law.prestress(stress, state);
  return law.yield(stress, state) / principal.norm();
}

MohrCoulomb planes()
{
  MohrCoulomb law;
  static_cast<Elasticity&>(law) = testing::soil(ConeMatch::outer, friction, cohesion);
  law.density = 2000;
  law.friction_angle = friction;
  law.cohesion = cohesion;
  return law;
}

TEST(Strength, OnEveryPlaneFallsToItsPart)
{
  for (const Real factor : {0.7, 1.0, 1.35, 3.0})
    for (const Real normal : {0.0, 2e4, 5e5}) {
      const Circle circle(normal, factor);
      MohrCoulomb law = planes();
      ASSERT_TRUE(divide_strength(law, factor));
      EXPECT_NEAR(excess(law, {circle.centre + circle.radius, circle.centre, circle.centre - circle.radius}), 0, digits);

      DruckerPrager cone = testing::soil(ConeMatch::plane_strain, friction, cohesion);
      ASSERT_TRUE(divide_strength(cone, factor));  // flow without strain out of plane: the mean of the others there
      EXPECT_NEAR(excess(cone, {circle.centre + circle.radius, circle.centre, circle.centre - circle.radius}), 0, digits);

      cone = testing::soil(ConeMatch::outer, friction, cohesion);  // triaxial compression
      divide_strength(cone, factor);
      EXPECT_NEAR(excess(cone, {circle.centre + circle.radius, circle.centre + circle.radius, circle.centre - circle.radius}), 0, digits);

      cone = testing::soil(ConeMatch::inner, friction, cohesion);  // triaxial extension
      divide_strength(cone, factor);
      EXPECT_NEAR(excess(cone, {circle.centre + circle.radius, circle.centre - circle.radius, circle.centre - circle.radius}), 0, digits);
    }
}

TEST(Strength, SoftenedSoilFallsLikeTheIntactOne)
{
  MohrCoulomb law = testing::sample<MohrCoulomb>();
  divide_strength(law, 1.5);
  EXPECT_NEAR(*law.residual_cohesion, 1e3 / 1.5, 1e-9);
  EXPECT_NEAR(std::tan(radians(*law.residual_friction_angle)), std::tan(radians(20)) / 1.5, 1e-14);
  EXPECT_EQ(*law.softening_strain, 0.05);
  EXPECT_NEAR(*law.tension_cutoff, 4e3 / 1.5, 1e-9);
  EXPECT_EQ(law.dilation_angle, 8);
}

TEST(Strength, DilationIsNeverAboveTheFrictionThatIsLeft)
{
  DruckerPrager law = testing::sample<DruckerPrager>();
  divide_strength(law, 5);
  EXPECT_EQ(law.dilation_angle, *law.residual_friction_angle);
  EXPECT_LT(law.dilation_angle, 5);
}

TEST(Strength, ACutOffIsLiftedToTheTipAtMost)
{
  MohrCoulomb law = planes();
  law.tension_cutoff = 0.9 * law.tip_of_strength();
  const Real tip = law.tip_of_strength();
  divide_strength(law, 0.5);
  EXPECT_NEAR(law.tip_of_strength(), tip, 1e-12 * tip);
  EXPECT_EQ(*law.tension_cutoff, law.tip_of_strength());
}

TEST(Strength, MetalFallsAtEveryStrainAndRate)
{
  VonMises law = testing::sample<VonMises>(), weak = law;
  law.rate = weak.rate = CowperSymonds{.reference_rate = 40, .exponent = 5};
  divide_strength(weak, 1.7);
  for (const Real strain : {0.0, 0.01, 0.4})
    for (const Real rate : {0.0, 10.0})
      EXPECT_NEAR(weak.flow_stress(strain, rate), law.flow_stress(strain, rate) / 1.7, digits * law.yield_stress);
}

TEST(Strength, CamClayFallsInTheTangentOfItsFrictionAngle)
{
  ModifiedCamClay law = testing::sample<ModifiedCamClay>();
  const auto tangent = [](Real slope) { return std::tan(std::asin(3 * slope / (6 + slope))); };
  const Real before = tangent(law.critical_state_slope);
  divide_strength(law, 1.4);
  EXPECT_NEAR(tangent(law.critical_state_slope), before / 1.4, 1e-14);
  EXPECT_EQ(law.preconsolidation_pressure, 1e5);
}

TEST(Strength, OfABodyWithItsConstants)
{
  Material clay = make_material(planes(), 0, 1, "clay");
  ASSERT_TRUE(clay.weaken(2));
  const auto& weaker = *law_as<MohrCoulomb>(clay);
  EXPECT_EQ(weaker.constants().peak.cohesive, weaker.parameters().constants().peak.cohesive);
  EXPECT_LT(weaker.constants().peak.cohesive, 0.55 * planes().constants().peak.cohesive);

  Material rubber = make_material(testing::sample<NeoHookean>(), 0, 1, "rubber");
  EXPECT_FALSE(rubber.weaken(2));
}

}  // namespace
}  // namespace talus::strength_test
