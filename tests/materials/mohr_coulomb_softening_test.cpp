// Mohr-Coulomb whose strength falls with plastic strain.
#include "tests/materials/mohr_coulomb_samples.hpp"

namespace talus::mohr_coulomb_test {
namespace {

TEST(MohrCoulombSoftening, ShearStressFallsLinearlyToResidualWhateverTheSteps)
{
  const MohrCoulomb law = softening(soil(0, 10e3), 0, 4e3, 0.05 / stiffening);
  const Real G = law.constants().shear, fall = 6e3 / (root3 * *law.softening_strain);  // of the stress per plastic shear
  for (const int steps : {1, 3, 200})
    for (const Real gamma : {0.01, 0.05, 0.2}) {
      Point<MohrCoulomb> point{.law = law};
      Mat3 H = Mat3::Zero();
      H(0, 1) = gamma / stiffening / steps;
      for (int n = 0; n < steps; ++n)
        point.strain(H);
      const Real plastic = (gamma / stiffening - 10e3 / G) / (1 - fall / G);
      EXPECT_NEAR(point.stress(0, 1), std::max(10e3 - fall * plastic, 4e3), machine * 1e4) << gamma << " in " << steps;
    }
}

TEST(MohrCoulombSoftening, TheStrengthFallsInProportionToThePlasticStrain)
{
  const MohrCoulomb law = softening(soil(35, 5e3, 10), 25, 1e3, 0.05 / stiffening);
  const Real peak = std::sin(radians(35)), residual = std::sin(radians(25));
  const Real peak_cohesive = 5e3 * std::cos(radians(35)), residual_cohesive = 1e3 * std::cos(radians(25));
  Point<MohrCoulomb> point{.law = law};
  point.prestress(-p0 * Mat3::Identity());
  Mat3 H = Mat3::Zero();
  H(0, 1) = 1e-3 / stiffening;
  int on_the_way = 0;
  for (int n = 0; n < 200; ++n) {
    point.strain(H);
    if (point.state.plastic_strain == 0)
      continue;
    const Vec3 s = principal(point.stress);
    const Real share = std::min(point.state.plastic_strain / *law.softening_strain, Real{1});
    const Real sine = peak + share * (residual - peak), cohesive = peak_cohesive + share * (residual_cohesive - peak_cohesive);
    EXPECT_NEAR(0.5 * (s[0] - s[2]), cohesive - 0.5 * (s[0] + s[2]) * sine, 10 * machine * p0) << n;
    on_the_way += share < 1 ? 1 : 0;
  }
  EXPECT_GT(on_the_way, 20);
  EXPECT_GT(point.state.plastic_strain, *law.softening_strain);
}

TEST(MohrCoulombSoftening, FrictionAndDilationSatisfyTheSoftenedPlanesAtTheEnd)
{
  const MohrCoulomb law = softening(soil(35, 5e3, 10), 25, 0, 0.05 / stiffening);
  Point<MohrCoulomb> point{.law = law};
  point.prestress(-p0 * Mat3::Identity());
  Mat3 H = Mat3::Zero();
  H(0, 1) = 1e-3 / stiffening;
  Real highest = 0;
  for (int n = 0; n < 200; ++n) {
    point.strain(H);
    const Vec3 s = principal(point.stress);
    const ShearStrength now = law.constants().strength_at(point.state.plastic_strain);
    const Real f = 0.5 * (s[0] - s[2]) + 0.5 * (s[0] + s[2]) * now.sine - now.cohesive;
    EXPECT_LE(f, machine * p0);
    if (point.state.plastic_strain > 0) {
      EXPECT_GE(f, -machine * p0);
    }
    highest = std::max(highest, (s[0] - s[2]) / -(s[0] + s[2]));
  }
  EXPECT_GT(point.state.plastic_strain, *law.softening_strain);
  const Vec3 s = principal(point.stress);
  EXPECT_NEAR((s[0] - s[2]) / -(s[0] + s[2]), std::sin(radians(25)), machine);
  EXPECT_GT(highest, std::sin(radians(25)));
}

TEST(MohrCoulombSoftening, BrittleSoilDropsToResidualAtOnce)
{
  const MohrCoulomb law = softening(soil(0, 10e3), 0, 1e3, 1e-6 / stiffening);  // shorter than the elastic strain that is released
  Point<MohrCoulomb> point{.law = law};
  Mat3 H = Mat3::Zero();
  H(0, 1) = 1.01 * 10e3 / law.constants().shear;
  point.strain(H);
  EXPECT_NEAR(point.stress(0, 1), 1e3, machine * 10e3);
  EXPECT_GT(point.state.plastic_strain, *law.softening_strain);
}

}  // namespace
}  // namespace talus::mohr_coulomb_test
