// Snow against closed forms of its clamped stretches, and against the algorithm of the paper with F_e and F_p.
#include "materials/snow.hpp"

#include <gtest/gtest.h>
#include <Eigen/SVD>

#include "tests/materials/samples.hpp"

namespace talus::snow_test {
namespace {

using testing::Dice;
using testing::Point;
using testing::problems_of;

/// The snow of the paper (Stomakhin et al. 2013, table 2).
Snow fresh()
{
  Snow law;
  law.density = 400;
  law.youngs_modulus = 1.4e5;
  law.poisson_ratio = 0.2;
  return law;
}
constexpr Real E = 1.4e5, low = 1 - 0.025, high = 1 + 0.0075, xi = 10;
constexpr Real M = E * 0.8 / (1.2 * 0.6), lambda = E * 0.2 / (1.2 * 0.6), mu = E / 2.4;  // nu = 0.2
constexpr Real digits = 1e-11;                                                           // of moduli

Mat3 along_z(Real stretch) { return Vec3(1, 1, stretch).asDiagonal(); }
/// Takes a point to a stretch along z without lateral strain.
void confine(Point<Snow>& point, Real to, int steps)
{
  const Real ratio = std::pow(to / point.F(2, 2), 1.0 / steps);
  for (int n = 0; n < steps; ++n)
    point.step(along_z(ratio));
}

TEST(Snow, ConfinedCompressionAndExtensionFollowTheClosedForm)
{
  for (const int steps : {1, 10, 300})
    for (const Real J : {0.99, 0.9, 0.5, 1.005, 1.1}) {
      Point<Snow> point{.law = fresh()};
      confine(point, J, steps);
      const Real s = std::clamp(J, low, high), J_p = J / s, h = std::exp(xi * (1 - J_p));
      EXPECT_NEAR(point.stress(2, 2), h * M * (s - 1) * s / J, digits * h * M) << J;
      EXPECT_NEAR(point.stress(0, 0), h * lambda * (s - 1) * s / J, digits * h * M);
      EXPECT_NEAR(point.stress(1, 1), point.stress(0, 0), digits * h * M);
      EXPECT_NEAR(std::exp(point.state.plastic_volume), J_p, digits);
      EXPECT_NEAR(point.state.plastic_strain, 2.0 / 3 * std::abs(std::log(J_p)), digits) << "uniaxial: 2/3 of the axial strain";
    }
}

TEST(Snow, UnloadsElasticallyWithTheModuliOfItsCompaction)
{
  Point<Snow> point{.law = fresh()};
  confine(point, 0.7, 50);
  const Snow::State compacted = point.state;
  const Real J_p = 0.7 / low, h = std::exp(xi * (1 - J_p));
  confine(point, J_p * 0.995, 1);
  EXPECT_NEAR(point.stress(2, 2), h * M * -0.005 * 0.995 / point.F(2, 2), digits * h * M);
  confine(point, J_p, 1);
  EXPECT_LE(point.stress.norm(), digits * h * M);
  EXPECT_EQ(point.state.plastic_volume, compacted.plastic_volume);
  EXPECT_EQ(point.state.plastic_work, compacted.plastic_work);
}

TEST(Snow, IsotropicCompressionFollowsTheClosedForm)
{
  Point<Snow> point{.law = fresh()};
  for (int n = 0; n < 20; ++n)
    point.step(0.98 * Mat3::Identity());
  const Real J = point.F.determinant(), J_e = low * low * low, h = std::exp(xi * (1 - J / J_e));
  const Real pressure = h * (2 * mu * (1 - low) * low + lambda * (1 - J_e) * J_e) / J;
  EXPECT_LE((point.stress + pressure * Mat3::Identity()).norm(), digits * pressure * 100);
  EXPECT_EQ(point.state.plastic_strain, 0) << "no change of shape";
}

TEST(Snow, PlasticWorkOfConfinedPathsIsTheWorkOfTheStressLessTheStoredEnergy)
{
  constexpr int steps = 20000;
  for (const Real end : {0.8, 1.2}) {
    Point<Snow> point{.law = fresh()};
    confine(point, end, steps);
    // Integral of h M (s - 1) s over the plastic strain ln J_p, by the midpoint rule.
    const Real s = end < 1 ? low : high, total = std::log(end / s);
    Real work = 0;
    for (int n = 0; n < steps; ++n)
      work += total / steps * std::exp(xi * (1 - std::exp(total * (n + 0.5) / steps))) * M * (s - 1) * s;
    const Real stored = (std::exp(xi * (1 - end / s)) - 1) * M * (s - 1) * (s - 1) / 2;  // by the change of moduli alone
    EXPECT_GT(std::abs(stored), 0.003 * work);
    EXPECT_NEAR(point.state.plastic_work, work - stored, 2e-4 * work);  // backward Euler: half a step of the change by exp(xi 0.2)
  }
}

TEST(Snow, ShearIsCutOffAtBothLimits)
{
  // x stretches and y shrinks; J_e of the clamped stretches is not one.
  Point<Snow> point{.law = fresh()};
  const Real stretch = 1.05;
  point.step(Vec3(stretch, 1 / stretch, 1).asDiagonal());
  const Real J_e = low * high, h = std::exp(xi * (1 - 1 / J_e)), volume = lambda * J_e * (J_e - 1);
  EXPECT_NEAR(point.stress(0, 0), h * (2 * mu * (high - 1) * high + volume), digits * M);
  EXPECT_NEAR(point.stress(1, 1), h * (2 * mu * (low - 1) * low + volume), digits * M);
  EXPECT_NEAR(point.stress(2, 2), h * volume, digits * M);
  EXPECT_GT(std::exp(point.state.plastic_volume), 1) << "sheared snow loosens, as it is torn sooner than compacted";
}

/// The algorithm of the paper, section 7: F_e by its singular values, F_p, and stress with the rotation.
struct ByThePaper {
  Mat3 elastic = Mat3::Identity(), plastic = Mat3::Identity();
  Mat3 step(const Mat3& f)
  {
    const Mat3 F = f * elastic * plastic;
    const Eigen::JacobiSVD<Mat3> svd(f * elastic, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Vec3 clamped = svd.singularValues().cwiseMax(low).cwiseMin(high);
    elastic = svd.matrixU() * clamped.asDiagonal() * svd.matrixV().transpose();
    plastic = svd.matrixV() * clamped.cwiseInverse().asDiagonal() * svd.matrixU().transpose() * F;
    const Mat3 R = svd.matrixU() * svd.matrixV().transpose();
    const Real J_e = elastic.determinant(), h = std::exp(xi * (1 - plastic.determinant()));
    return h / F.determinant() * (2 * mu * (elastic - R) * elastic.transpose() + lambda * (J_e - 1) * J_e * Mat3::Identity());
  }
};

TEST(Snow, IsTheAlgorithmOfThePaperAlongAnyPath)
{
  Dice dice(1);
  int torn = 0, compacted = 0;
  for (int path = 0; path < 100; ++path) {
    Point<Snow> point{.law = fresh()};
    ByThePaper paper;
    for (int n = 0; n < 30; ++n) {
      const Mat3 f = dice.rotation() * (Mat3::Identity() + dice.matrix(std::pow(10, dice.real(-4, -1))));
      point.step(f);
      const Mat3 expected = paper.step(f);
      const Real factor = std::max(std::exp(xi * (1 - paper.plastic.determinant())), Real{1});
      ASSERT_LE((point.stress - expected).norm(), 1e-10 * factor * M) << path << " " << n;
      ASSERT_NEAR(std::exp(point.state.plastic_volume) / paper.plastic.determinant(), 1, 1e-11);
    }
    (point.state.plastic_volume > 0 ? torn : compacted)++;
  }
  EXPECT_GT(torn, 10);
  EXPECT_GT(compacted, 10);
}

TEST(Snow, HardeningStopsAtItsLimit)
{
  Snow law = fresh();
  law.hardening_limit = 7;
  Point<Snow> limited{.law = law}, free{.law = fresh()};
  confine(limited, 0.6, 10);
  confine(free, 0.6, 10);
  EXPECT_NEAR(limited.stress(2, 2), -7 * M * (1 - low) * low / 0.6, digits * 7 * M);
  EXPECT_NEAR(free.stress(2, 2) / limited.stress(2, 2), std::exp(xi * (1 - 0.6 / low)) / 7, 1e-10);
  EXPECT_NEAR(limited.law.wave_speed(limited.F, limited.state, limited.constants) * std::sqrt(std::exp(xi * (1 - 0.6 / low)) / 7),
              free.law.wave_speed(free.F, free.state, free.constants), 1e-9);
  confine(free, 1e-9, 1);
  EXPECT_LE(free.constants.factor(free.state.plastic_volume), std::exp(xi)) << "no compaction hardens more";
}

TEST(Snow, PlasticWorkIsNeverNegative)
{
  Dice dice(2);
  Snow law = fresh();
  law.poisson_ratio = 0.45;  // strong coupling of the directions
  for (int path = 0; path < 200; ++path) {
    Point<Snow> point{.law = law};
    for (int n = 0; n < 20; ++n) {
      const Snow::State before = point.state;
      point.step(Mat3::Identity() + dice.matrix(0.03));
      ASSERT_GE(point.state.plastic_work, before.plastic_work);
      ASSERT_GE(point.state.plastic_strain, before.plastic_strain);
    }
  }
}

TEST(Snow, PrestressInsideTheLimitsIsElasticAndOutsideCompacts)
{
  const Mat3 Q = testing::rotation_about({1, 2, 3}, 0.7);
  const Mat3 light = Q * Vec3(-500, -900, -2000).asDiagonal() * Q.transpose(),
             heavy = Q * Vec3(-4e3, -5e3, -2e4).asDiagonal() * Q.transpose();
  Point<Snow> inside{.law = fresh()}, outside{.law = fresh()};
  inside.prestress(light);
  EXPECT_EQ(inside.state.plastic_volume, 0);
  outside.prestress(heavy);
  EXPECT_LT(outside.state.plastic_volume, 0);
  EXPECT_NEAR(outside.law.yield(heavy, outside.state), 0, 1e-6 * M) << "compacted as little as bears it";
  inside.step(Mat3::Identity());
  EXPECT_LE((inside.stress - light).norm(), digits * M);
  outside.step(Mat3::Identity());
  EXPECT_LE((outside.stress - heavy).norm(), digits * M * 10);
  EXPECT_EQ(outside.state.plastic_work, 0);
}

TEST(Snow, WaveSpeedOfTheHistoryBoundsThatOfTheStress)
{
  Dice dice(3);
  constexpr Real h = 1e-6;
  Real closest = 0;
  for (int n = 0; n < 300; ++n) {
    Point<Snow> point{.law = fresh()};
    for (int step = 0; step < n % 7; ++step)
      point.step((n % 2 ? 0.97 : 1) * Mat3::Identity() + dice.matrix(0.05));
    const Vec3 normal = dice.direction();
    Mat3 acoustic;
    for (int d = 0; d < 3; ++d) {
      const auto traction = [&](Real size) -> Vec3 {
        Point<Snow> moved = point;
        const Mat3 f = Mat3::Identity() + size * Vec3::Unit(d) * normal.transpose();
        moved.step(f, true);
        return f.determinant() * moved.stress * f.inverse().transpose() * normal;
      };
      acoustic.col(d) = (traction(h) - traction(-h)) / (2 * h);
    }
    const Real modulus = Eigen::SelfAdjointEigenSolver<Mat3>(sym(acoustic)).eigenvalues().maxCoeff();
    const Real speed = std::sqrt(modulus * point.F.determinant() / point.law.density);
    const Real bound = point.law.wave_speed(point.F, point.state, point.constants);
    ASSERT_LE(speed, (1 + 1e-6) * bound) << n;
    closest = std::max(closest, speed / bound);
  }
  EXPECT_GT(closest, 0.99);
}

TEST(SnowRules, LimitsAreFieldsWithTheValuesOfThePaper)
{
  Snow law;
  EXPECT_EQ(law.critical_compression, 0.025);
  EXPECT_EQ(law.critical_stretch, 0.0075);
  EXPECT_EQ(law.hardening, 10);
  EXPECT_EQ(problems_of(fresh(), [](Snow&) {}), testing::Problems{});
  EXPECT_EQ(problems_of(fresh(), [](Snow& it) { it.poisson_ratio.reset(); }).size(), 1u);
}

}  // namespace
}  // namespace talus::snow_test
