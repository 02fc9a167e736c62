// Mohr-Coulomb in tension: the apex, soil that has separated, the cut-off.
#include "tests/materials/mohr_coulomb_samples.hpp"

namespace talus::mohr_coulomb_test {
namespace {

TEST(MohrCoulomb, IsotropicExtensionEndsAtTheApex)
{
  for (const Real cohesion : {0.0, 5e3})
    for (const Real psi : {0.0, 10.0, 30.0})
      for (const Real size : {1e-9, 1e-3, 1.0, 10.0}) {  // in units of 1e-12
        Point<MohrCoulomb> point{.law = soil(30, cohesion, psi)};
        point.strain(size * 1e-12 * Mat3::Identity());
        const Real apex = cohesion / std::tan(radians(30));
        const Real elastic = 3 * point.law.constants().bulk * size * 1e-12;
        EXPECT_LE((point.stress - std::min(apex, elastic) * Mat3::Identity()).norm(), machine * apex);
      }
}

TEST(MohrCoulomb, SeparatedCohesionlessSoilStaysFreeOfStressUntilItCloses)
{
  testing::expect_no_stress_until_closed(Point<MohrCoulomb>{.law = soil(30, 0, 10)});
}

TEST(MohrCoulomb, CohesiveCrackClosesWithoutTensionAndWithoutGivingWorkBack)
{
  for (const bool cut : {false, true}) {
    Point<MohrCoulomb> point{.law = cut ? with_cutoff(soil(30, 5e3), 3e3) : soil(30, 5e3)};
    const Real limit = cut ? 3e3 : 5e3 / std::tan(radians(30)), elastic = limit / point.law.constants().bulk;
    point.strain(100 * elastic / 3 * Mat3::Identity());
    const Real work = point.state.plastic_work;
    EXPECT_NEAR(point.state.opened_volume, 99 * elastic, machine * 100 * elastic);
    EXPECT_NEAR(work, 99 * elastic * limit, machine * work);
    point.strain(-50 * elastic / 3 * Mat3::Identity());
    EXPECT_NEAR(point.stress.norm(), 0, machine * limit);
    EXPECT_NEAR(point.state.opened_volume, 50 * elastic, machine * 100 * elastic);
    point.strain(-51 * elastic / 3 * Mat3::Identity());
    EXPECT_NEAR(point.stress(0, 0), -limit, 100 * machine * limit);
    EXPECT_EQ(point.state.opened_volume, 0);
    EXPECT_EQ(point.state.plastic_work, work);
  }
}

TEST(MohrCoulomb, DilationOfSeparatedSoilFillsTheGapFirst)
{
  Point<MohrCoulomb> point{.law = soil(30, 5e3, 20)};
  point.strain(1e-10 * Mat3::Identity());
  const Real open = point.state.opened_volume, G = point.law.constants().shear;
  point.strain(-1.1 * 5e3 / std::tan(radians(30)) / (3 * point.law.constants().bulk) * Mat3::Identity());
  const Real closing = point.state.opened_volume;
  EXPECT_LT(closing, open);
  Mat3 H = Mat3::Zero();
  const Real gamma = 2e-13, epsilon = 1e-14;  // shear strength is reached at 1.1e-13
  H(0, 1) = gamma;
  H(1, 1) = -epsilon;
  point.strain(H);
  // At zero mean stress the shear on the plane is half of (s1 - s3): c cos(phi), but for the mean of s1 and s3 that epsilon makes.
  EXPECT_NEAR(mean(point.stress), 0, machine * G * gamma);
  const Vec3 s = principal(point.stress);
  const auto c = point.law.constants();
  const Real J = point.F.determinant();
  EXPECT_NEAR(J * ((s[0] - s[2]) + (s[0] + s[2]) * c.peak.sine), 2 * c.peak.cohesive, machine * G * gamma);
  const Real plastic_shear = std::hypot(gamma, epsilon) - (s[0] - s[2]) / (2 * G);
  EXPECT_NEAR(point.state.opened_volume, closing - epsilon - c.sin_psi * plastic_shear, 1e-6 * plastic_shear);
}

TEST(MohrCoulomb, TensionCutoffLimitsTheLargestPrincipalStress)
{
  const MohrCoulomb law = with_cutoff(soil(30, 5e3), 2e3);
  const auto c = law.constants();
  const Real lambda = c.bulk - 2 * c.shear / 3;
  const auto after = [&](const Vec3& trial) {
    Point<MohrCoulomb> point{.law = law};
    const Vec3 strain = (trial.array() - trial.mean()) / (2 * c.shear) + trial.mean() / (3 * c.bulk);
    point.strain(strain.asDiagonal());
    return point;
  };
  const Real ratio = lambda / (lambda + 2 * c.shear);  // of the stresses in uniaxial strain
  const auto one = after({5e3, 5e3 * ratio, 5e3 * ratio});
  EXPECT_LE((one.stress - Mat3(Vec3(2e3, 2e3 * ratio, 2e3 * ratio).asDiagonal())).norm(), machine * 5e3) << "as if less had been pulled";
  EXPECT_EQ(one.state.opened_volume, 0);
  const auto three = after({5e3, 5e3, 5e3});
  EXPECT_LE((three.stress - 2e3 * Mat3::Identity()).norm(), machine * 5e3);
  EXPECT_NEAR(three.state.opened_volume, 3e3 / c.bulk, machine * 3e3 / c.bulk);
  EXPECT_NEAR(three.state.plastic_strain, 0, machine * 3e3 / c.bulk);
  const Real s3 = (2e3 * 1.5 - 2 * c.peak.cohesive) / 0.5;  // of the plane at s1 = 2 kPa
  const auto corner = after({4e4, 3.9e4, -3e4});
  EXPECT_LE((corner.stress - Mat3(Vec3(2e3, 2e3, s3).asDiagonal())).norm(), machine * 4e4);
  // On the edge x cracks and the plane flows by psi = 0: s2 = trial - lambda crack, (crack, plane) from s1 and s3.
  const auto edge = after({3e4, 3e3, -3e4});
  const Real total = 3e4 - 2e3 - 3e4 - s3;  // fall of s1 + s3 = 2 (lambda + mu) crack
  EXPECT_LE((edge.stress - Mat3(Vec3(2e3, 3e3 - lambda * total / (2 * (lambda + c.shear)), s3).asDiagonal())).norm(), machine * 3e4);
}

}  // namespace
}  // namespace talus::mohr_coulomb_test
