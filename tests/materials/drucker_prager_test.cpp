// The cone, its return and its history against closed forms.  Stiffnesses are 1e10 times those of soil where the closed form is one of
// small strain: strains of 1e-11 make Kirchhoff and Cauchy stress equal to the tolerance, and cost no digits.
#include <gtest/gtest.h>

#include "tests/materials/soil.hpp"

namespace talus::drucker_prager_test {
namespace {

using testing::Dice;
using testing::Point;
using testing::radians;
using testing::rotation_about;
using testing::soil;

constexpr std::array<ConeMatch, 3> all_matches{ConeMatch::outer, ConeMatch::inner, ConeMatch::plane_strain};
constexpr Real machine = 1e-10;  // relative: what the closed forms claim
const Real root3 = std::sqrt(3.0);

Real tau_of(const Mat3& stress) { return std::sqrt(second_invariant(stress)); }

TEST(DruckerPragerMatch, OuterInnerAndPlaneStrainConesHaveTheirConstants)
{
  // phi, c; q of outer, inner, plane strain with psi = phi, plane strain with psi = 0 (rounded to the digits given).
  struct Row {
    Real phi, outer, inner, associated, isochoric;
  };
  for (const Row& row : {Row{20, .44575, .35451, .33554, .34202}, Row{30, .69282, .49487, .48038, .50000},
                         Row{19.8, .44093, .35146, .33244, .33874}, Row{32, .74317, .52004, .50673, .52992}}) {
    EXPECT_NEAR(soil(ConeMatch::outer, row.phi, 0).cone(0).q, row.outer, 6e-6);
    EXPECT_NEAR(soil(ConeMatch::inner, row.phi, 0).cone(0).q, row.inner, 6e-6);
    EXPECT_NEAR(soil(ConeMatch::plane_strain, row.phi, 0, row.phi).cone(0).q, row.associated, 6e-6);
    EXPECT_NEAR(soil(ConeMatch::plane_strain, row.phi, 0).cone(0).q, row.isochoric, 6e-6);
  }
  EXPECT_NEAR(soil(ConeMatch::outer, 20, 1e4).cone(0).k, 12247, 0.6);
  EXPECT_NEAR(soil(ConeMatch::inner, 20, 1e4).cone(0).k, 9740, 0.6);
  EXPECT_NEAR(soil(ConeMatch::plane_strain, 20, 1e4, 20).cone(0).k, 9219, 0.6);
  EXPECT_NEAR(soil(ConeMatch::plane_strain, 20, 1e4).cone(0).k, 9397, 0.6);
}

TEST(DruckerPragerMatch, DilationNeverExceedsFriction)
{
  for (const ConeMatch match : all_matches)
    for (Real phi = 0; phi < 60; phi += 5)
      for (Real psi = 0; psi <= phi; psi += 5)
        EXPECT_LE(soil(match, phi, 0, psi).dilation_slope(), soil(match, phi, 0, psi).cone(0).q * (1 + 1e-14));
}

TEST(DruckerPrager, ReturnIsTheClosedFormOfPerfectPlasticity)
{
  Dice dice(1);
  for (const ConeMatch match : all_matches) {
    const DruckerPrager law = soil(match, 30, 5e3, 12);
    const auto c = law.constants();
    int returned = 0;
    for (int n = 0; n < 3000; ++n) {
      Point<DruckerPrager> point{.law = law};
      const Mat3 trial = dice.symmetric(5e5) - dice.real(0, 5e5) * Mat3::Identity();
      point.strain(trial / c.shear / 2 - (trial.trace() / c.shear / 6 - trial.trace() / c.bulk / 9) * Mat3::Identity());
      const Real mean = trial.trace() / 3, tau = tau_of(trial), f = tau + c.peak.q * mean - c.peak.k;
      const Real multiplier = f / (c.shear + c.bulk * c.peak.q * c.q_psi);
      if (f < 0 || tau < c.shear * multiplier)
        continue;
      ++returned;
      EXPECT_NEAR(point.stress.trace() / 3, mean - c.bulk * c.q_psi * multiplier, machine * 1e6);
      EXPECT_LE((dev(point.stress) - (1 - c.shear * multiplier / tau) * dev(trial)).norm(), machine * 1e6);
      EXPECT_NEAR(point.state.plastic_strain, multiplier / root3, machine * tau / c.shear);
    }
    EXPECT_GT(returned, 500);
  }
}

TEST(DruckerPrager, EndsOnOrInsideTheYieldSurfaceFromAnyTrialState)
{
  Dice dice(2);
  std::vector<DruckerPrager> soils{soil(ConeMatch::outer, 0, 5e3), soil(ConeMatch::plane_strain, 30, 0, 30), soil(ConeMatch::inner, 0, 0)};
  for (const ConeMatch match : all_matches) {
    soils.push_back(soil(match, 35, 5e3, 10));
    soils.back().tension_cutoff = 2e3;
    soils.push_back(soil(match, 35, 5e3, 10));
    soils.back().residual_friction_angle = 20, soils.back().residual_cohesion = 0, soils.back().softening_strain = 0.01 * 1e-10;
  }
  constexpr int trials = 100000;
  for (int n = 0; n < trials; ++n) {
    const DruckerPrager& law = soils[static_cast<std::size_t>(n) % soils.size()];
    Point<DruckerPrager> point{.law = law};
    point.state.plastic_strain = dice.real(0, 0.02) * 1e-10;
    const Real size = std::pow(10.0, dice.real(-12, 0)) * 1e-10;
    Mat3 H = n % 10 == 0 ? Mat3(dice.real(-size, size) * Mat3::Identity()) : dice.matrix(size);  // tau = 0 every tenth time
    const auto c = law.constants();
    const Real trial_stress = c.bulk * H.norm();
    point.strain(H);
    ASSERT_TRUE(point.stress.allFinite());
    ASSERT_LE(law.yield(point.stress, point.state), machine * trial_stress);
    ASSERT_LE(point.stress.trace() / 3, law.tension_cutoff.value_or(1e300) + machine * trial_stress);
    ASSERT_GE(point.state.plastic_work, 0);
    ASSERT_GE(point.state.opened_volume, -1e-12 * size);
  }
}

TEST(DruckerPrager, ConstantVolumeSimpleShearFollowsTheClosedForm)
{
  constexpr Real p0 = 1e5, gamma = 0.02 / testing::stiffening;
  DruckerPrager law = soil(ConeMatch::outer, 30, 5e3);
  // q_psi = 0.2 of the closed form's example: sin(psi) = 3 sqrt3 q / (6 + sqrt3 q) for the outer cone.
  law.dilation_angle = std::asin(3 * root3 * 0.2 / (6 + root3 * 0.2)) / radians(1);
  const auto c = law.constants();
  ASSERT_NEAR(c.q_psi, 0.2, 1e-14);
  const Real gamma_y = (c.peak.k + c.peak.q * p0) / c.shear;
  const Real hardening = c.shear * c.bulk * c.peak.q * c.q_psi / (c.shear + c.bulk * c.peak.q * c.q_psi);
  for (const int steps : {1, 7, 100}) {
    Point<DruckerPrager> point{.law = law};
    point.prestress(-p0 * Mat3::Identity());
    Mat3 H = Mat3::Zero();
    H(0, 1) = gamma / steps;
    for (int n = 0; n < steps; ++n)
      point.strain(H);
    EXPECT_NEAR(point.stress(0, 1), c.peak.k + c.peak.q * p0 + (gamma - gamma_y) * hardening, machine * p0);
    EXPECT_NEAR(point.stress.trace() / 3, -p0 - hardening / c.peak.q * (gamma - gamma_y), machine * p0);
    EXPECT_NEAR(point.stress(0, 1), 75660.95, 0.006);
    EXPECT_NEAR(point.stress.trace() / 3, -100546.92, 0.006);
  }
}

TEST(DruckerPrager, IsotropicExtensionEndsAtTheTipOfTheCone)
{
  for (const ConeMatch match : all_matches)
    for (const Real cohesion : {0.0, 5e3})
      for (const Real size : {1e-9, 1e-3, 1.0, 10.0}) {  // in units of 1e-12
        Point<DruckerPrager> point{.law = soil(match, 30, cohesion, 10)};
        point.strain(size * 1e-12 * Mat3::Identity());
        const Real tip = cohesion / std::tan(radians(30));
        const Real elastic = 3 * point.law.constants().bulk * size * 1e-12;
        EXPECT_LE((point.stress - std::min(tip, elastic) * Mat3::Identity()).norm(), machine * tip);
      }
}

TEST(DruckerPrager, SeparatedCohesionlessSoilStaysFreeOfStressUntilItCloses)
{
  testing::expect_no_stress_until_closed(Point<DruckerPrager>{.law = soil(ConeMatch::inner, 30, 0, 10)});
}

TEST(DruckerPrager, CohesiveCrackClosesWithoutTensionAndWithoutGivingWorkBack)
{
  Point<DruckerPrager> point{.law = soil(ConeMatch::inner, 30, 5e3)};
  const Real tip = 5e3 / std::tan(radians(30)), elastic = tip / point.law.constants().bulk;
  point.strain(100 * elastic / 3 * Mat3::Identity());
  const Real work = point.state.plastic_work;
  EXPECT_NEAR(point.state.opened_volume, 99 * elastic, machine * 100 * elastic);
  EXPECT_NEAR(work, 99 * elastic * tip, machine * work);
  point.strain(-50 * elastic / 3 * Mat3::Identity());
  EXPECT_NEAR(point.stress.norm(), 0, machine * tip);
  EXPECT_NEAR(point.state.opened_volume, 50 * elastic, machine * 100 * elastic);
  point.strain(-51 * elastic / 3 * Mat3::Identity());
  EXPECT_NEAR(point.stress(0, 0), -tip, 100 * machine * tip);
  EXPECT_EQ(point.state.opened_volume, 0);
  EXPECT_EQ(point.state.plastic_work, work);
}

TEST(DruckerPrager, DilationOfSeparatedSoilFillsTheGapFirst)
{
  Point<DruckerPrager> point{.law = soil(ConeMatch::outer, 30, 0, 20)};
  point.strain(1e-10 * Mat3::Identity());
  const Real open = point.state.opened_volume;
  Mat3 H = Mat3::Zero();
  H(0, 1) = 1e-11;
  H(1, 1) = -1e-12;
  point.strain(H);
  EXPECT_LT(point.stress.norm(), machine * 1e-10 * *point.law.youngs_modulus);  // of the stress these strains would make
  EXPECT_LT(point.state.opened_volume, open);
  EXPECT_GT(point.state.opened_volume, 0);
}

TEST(DruckerPrager, TensionCutoffLimitsTheMeanStressAndKeepsTheShear)
{
  DruckerPrager law = soil(ConeMatch::plane_strain, 30, 5e3);
  law.tension_cutoff = 1e3;
  const auto c = law.constants();
  Point<DruckerPrager> weak{.law = law}, corner{.law = law};
  Mat3 H = 1e-12 * Mat3::Identity();
  H(0, 1) = 1e3 / c.shear;
  weak.strain(H);
  EXPECT_NEAR(weak.stress.trace() / 3, 1e3, machine * 1e3);
  EXPECT_NEAR(weak.stress(0, 1), 1e3, machine * 1e3);
  EXPECT_EQ(weak.state.plastic_strain, 0);
  H(0, 1) = 1e5 / c.shear;
  corner.strain(H);
  EXPECT_NEAR(corner.stress.trace() / 3, 1e3, machine * 1e3);
  EXPECT_NEAR(tau_of(corner.stress), c.peak.k - c.peak.q * 1e3, machine * 1e3);
  EXPECT_NEAR(corner.state.plastic_strain, (1e5 - tau_of(corner.stress)) / c.shear / root3, machine * 1e5 / c.shear);
}

TEST(DruckerPragerSoftening, ShearStressFallsLinearlyToResidualWhateverTheSteps)
{
  DruckerPrager law = soil(ConeMatch::outer, 0, 10e3);
  law.residual_cohesion = 4e3;
  law.softening_strain = 0.05 / testing::stiffening;
  const auto c = law.constants();
  const Real fall = (c.peak.k - c.residual.k) / (root3 * *law.softening_strain);  // of tau per plastic shear
  for (const int steps : {1, 3, 200})
    for (const Real gamma : {0.01, 0.05, 0.2}) {
      Point<DruckerPrager> point{.law = law};
      Mat3 H = Mat3::Zero();
      H(0, 1) = gamma / testing::stiffening / steps;
      for (int n = 0; n < steps; ++n)
        point.strain(H);
      const Real plastic = (gamma / testing::stiffening - c.peak.k / c.shear) / (1 - fall / c.shear);
      const Real expected = std::max(c.peak.k - fall * plastic, c.residual.k);
      EXPECT_NEAR(point.stress(0, 1), expected, machine * c.peak.k) << gamma << " in " << steps;
    }
}

TEST(DruckerPragerSoftening, AStepThatPassesTheEndOfSofteningByLittleEndsAtResidual)
{
  DruckerPrager law = soil(ConeMatch::outer, 0, 10e3);
  law.residual_cohesion = 4e3;
  law.softening_strain = 0.05 / testing::stiffening;
  const auto c = law.constants();
  const Real left = root3 * *law.softening_strain, fall = (c.peak.k - c.residual.k) / left;  // of tau per plastic shear
  for (const Real part : {0.5, 0.99, 0.999, 1.001, 1.005, 1.01}) {
    Point<DruckerPrager> point{.law = law};
    Mat3 H = Mat3::Zero();
    const Real plastic = part * left;  // if softening went on for ever
    H(0, 1) = (c.peak.k - fall * plastic) / c.shear + plastic;
    point.strain(H);
    EXPECT_NEAR(point.stress(0, 1), std::max(c.peak.k - fall * plastic, c.residual.k), machine * c.peak.k) << part;
    EXPECT_NEAR(point.state.plastic_strain, (H(0, 1) - point.stress(0, 1) / c.shear) / root3, machine * *law.softening_strain) << part;
  }
}

TEST(DruckerPragerSoftening, TheConeShrinksInProportionToThePlasticStrain)
{
  DruckerPrager law = soil(ConeMatch::plane_strain, 35, 5e3, 10);
  law.residual_friction_angle = 25, law.residual_cohesion = 1e3, law.softening_strain = 0.05 / testing::stiffening;
  const Cone peak = law.cone_of(35, 5e3), residual = law.cone_of(25, 1e3);
  Point<DruckerPrager> point{.law = law};
  point.prestress(-1e5 * Mat3::Identity());
  Mat3 H = Mat3::Zero();
  H(0, 1) = 1e-3 / testing::stiffening;
  int on_the_way = 0;
  for (int n = 0; n < 200; ++n) {
    point.strain(H);
    if (point.state.plastic_strain == 0)
      continue;
    const Real share = std::min(point.state.plastic_strain / *law.softening_strain, Real{1});
    const Real q = peak.q + share * (residual.q - peak.q), k = peak.k + share * (residual.k - peak.k);
    EXPECT_NEAR(tau_of(point.stress), k - q * point.stress.trace() / 3, 10 * machine * 1e5) << n;
    on_the_way += share < 1 ? 1 : 0;
  }
  EXPECT_GT(on_the_way, 20);
  EXPECT_GT(point.state.plastic_strain, *law.softening_strain);
}

TEST(DruckerPragerSoftening, FrictionAndDilationSatisfyTheSoftenedConeAtTheEnd)
{
  DruckerPrager law = soil(ConeMatch::plane_strain, 35, 5e3, 10);
  law.residual_friction_angle = 25, law.residual_cohesion = 0, law.softening_strain = 0.05 / testing::stiffening;
  Point<DruckerPrager> point{.law = law};
  point.prestress(-1e5 * Mat3::Identity());
  Mat3 H = Mat3::Zero();
  H(0, 1) = 1e-3 / testing::stiffening;
  Real highest = 0;
  for (int n = 0; n < 200; ++n) {
    point.strain(H);
    highest = std::max(highest, point.stress(0, 1) / -point.stress(1, 1));
    EXPECT_LE(law.yield(point.stress, point.state), machine * 1e5);
  }
  EXPECT_GT(point.state.plastic_strain, *law.softening_strain);
  EXPECT_NEAR(tau_of(point.stress), -law.cone(1).q * point.stress.trace() / 3, machine * 1e5);
  EXPECT_GT(highest, point.stress(0, 1) / -point.stress(1, 1));
}

TEST(DruckerPragerSoftening, BrittleSoilDropsToResidualAtOnce)
{
  DruckerPrager law = soil(ConeMatch::outer, 0, 10e3);
  law.residual_cohesion = 1e3;
  law.softening_strain = 1e-6 / testing::stiffening;  // shorter than the elastic strain that is released
  Point<DruckerPrager> point{.law = law};
  Mat3 H = Mat3::Zero();
  H(0, 1) = 1.01 * law.cone(0).k / law.constants().shear;
  point.strain(H);
  EXPECT_NEAR(point.stress(0, 1), law.cone(1).k, machine * law.cone(0).k);
}

TEST(DruckerPragerSoftening, WithoutResidualValuesTheStrengthStays)
{
  Point<DruckerPrager> point{.law = soil(ConeMatch::outer, 0, 10e3)};
  Mat3 H = Mat3::Zero();
  H(0, 1) = 0.1 / testing::stiffening;
  for (int n = 0; n < 100; ++n)
    point.strain(H);
  EXPECT_NEAR(point.stress(0, 1), point.law.cone(0).k, machine * 1e4);
}

TEST(DruckerPrager, PlasticWorkIsStressTimesPlasticShear)
{
  Point<DruckerPrager> point{.law = soil(ConeMatch::inner, 25, 8e3)};
  point.prestress(-5e4 * Mat3::Identity());
  const auto c = point.law.constants();
  const Real strength = c.peak.k + c.peak.q * 5e4, gamma = 0.05 / testing::stiffening;
  Mat3 H = Mat3::Zero();
  H(0, 1) = gamma / 20;
  for (int n = 0; n < 20; ++n)
    point.strain(H);
  const Real plastic = gamma - strength / c.shear;
  EXPECT_NEAR(point.state.plastic_strain, plastic / root3, machine * plastic);
  EXPECT_NEAR(point.state.plastic_work, strength * plastic, machine * strength * plastic);
}

TEST(DruckerPrager, QuarterTurnInAnyNumberOfStepsKeepsPrincipalStresses)
{
  const Mat3 start = Vec3(-1e5, -6e4, -8e4).asDiagonal();
  for (const int steps : {1, 10, 100}) {
    Point<DruckerPrager> point{.law = testing::soft_soil(ConeMatch::outer, 40, 5e3)};
    point.prestress(start);
    for (int n = 0; n < steps; ++n)
      point.step(rotation_about(Vec3::UnitZ(), std::acos(0.0) / steps));
    EXPECT_LE((point.stress - Mat3(Vec3(-6e4, -1e5, -8e4).asDiagonal())).norm(), 1e-15 * steps * 1e7);  // rounding of f - I times E
  }
}

TEST(DruckerPrager, ElasticSimpleShearToTenDoesNotOscillate)
{
  for (const int steps : {1, 10, 1000}) {
    Point<DruckerPrager> point{.law = testing::soft_soil(ConeMatch::outer, 30, 0)};
    Mat3 f = Mat3::Identity();
    f(0, 1) = 10.0 / steps;
    for (int n = 0; n < steps; ++n)
      point.step(f, true);
    const Real G = point.law.constants().shear;
    EXPECT_NEAR(point.stress(0, 1), 4 * G * std::asinh(5.0) / std::sqrt(104.0), 1e-9 * G);  // rounding times condition 1e4 of b
  }
}

TEST(DruckerPragerRules, ContradictionsAreToldInWords)
{
  const auto problems = [](auto change) { return testing::problems_of(soil(ConeMatch::outer, 30, 5e3, 10), change); };
  using testing::Problems;
  EXPECT_EQ(problems([](auto&) {}), Problems{});
  EXPECT_EQ(problems([](auto& law) { law.dilation_angle = 31; }), Problems{"dilation_angle 31 is above friction_angle 30"});
  EXPECT_EQ(problems([](auto& law) { law.tension_cutoff = 9e3; }),
            Problems{"tension_cutoff 9000 is above the tip of the cone, 8660.25 Pa"});
  EXPECT_EQ(problems([](auto& law) { law.residual_cohesion = 6e3, law.softening_strain = 0.1; }),
            Problems{"residual_cohesion 6000 is above cohesion 5000"});
  EXPECT_EQ(problems([](auto& law) { law.residual_cohesion = 0; }),
            Problems{"residual_friction_angle and residual_cohesion need softening_strain"});
  EXPECT_EQ(problems([](auto& law) { law.softening_strain = 0.1; }),
            Problems{"softening_strain needs residual_friction_angle or residual_cohesion"});
  EXPECT_EQ(problems([](auto& law) { law.residual_friction_angle = 5, law.softening_strain = 0.1; }),
            Problems{"dilation_angle 10 is above residual_friction_angle 5"});
  EXPECT_EQ(problems([](auto& law) { law.residual_friction_angle = 35, law.softening_strain = 0.1; }),
            Problems{"residual_friction_angle 35 is above friction_angle 30"});
}

}  // namespace
}  // namespace talus::drucker_prager_test
