// Cam clay with cohesion: its two curves of hardening, its apex, its flow, and modified Cam clay where there is no cohesion.
#include "materials/cohesive_cam_clay.hpp"

#include <gmock/gmock.h>

#include "materials/parts/radial_return.hpp"
#include "tests/materials/samples.hpp"

namespace talus::cohesive_cam_clay_test {
namespace {

using testing::Dice;
using testing::Point;
using testing::problems_of;

constexpr Real K = 5e6, G = 3e6, p0 = 2e5, beta = 0.3, xi = 2;

/// Linear elasticity, hardening by the hyperbolic sine.
CohesiveCamClay firn()
{
  CohesiveCamClay law;
  law.density = 300;
  law.bulk_modulus = K;
  law.shear_modulus = G;
  law.critical_state_slope = 1.2;
  law.cohesion_ratio = beta;
  law.preconsolidation_pressure = p0;
  law.hardening_factor = xi;
  return law;
}
/// Exponential elasticity and hardening.
CohesiveCamClay chalk()
{
  CohesiveCamClay law = testing::as_cohesive(testing::sample<ModifiedCamClay>());
  law.cohesion_ratio = beta;
  return law;
}
const Real compacted = std::asinh(p0 / K) / xi;  // at the start

Mat3 swell(Real log_volume) { return std::exp(log_volume / 3) * Mat3::Identity(); }
Mat3 squeeze(Real axial) { return Vec3(-axial / 2, -axial / 2, axial).array().exp().matrix().asDiagonal(); }
template <class L>
Real p_of(const Point<L>& at)
{
  return -at.F.determinant() * at.stress.trace() / 3;
}
template <class L>
Real q_of(const Point<L>& at)
{
  return at.F.determinant() * von_mises(at.stress);
}
template <class L>
void go(Point<L>& point, Real log_volume, int steps)
{
  for (int n = 0; n < steps; ++n)
    point.step(swell(log_volume / steps));
}

TEST(CohesiveCamClay, WithoutCohesionAndWithTheSameCurvesIsModifiedCamClay)
{
  Dice dice(1);
  const ModifiedCamClay clay = testing::sample<ModifiedCamClay>();
  int opened = 0, softened = 0, hardened = 0;
  for (int path = 0; path < 200; ++path) {
    Point<ModifiedCamClay> point{.law = clay};
    Point<CohesiveCamClay> same{.law = testing::as_cohesive(clay)};
    if (path % 2) {
      const Mat3 start = -dice.real(1e3, 2e5) * Mat3::Identity() + dice.symmetric(5e4);
      point.prestress(start), same.prestress(start);
    }
    for (int n = 0; n < 30; ++n) {
      const Mat3 f = Mat3::Identity() + dice.matrix(0.02) - dice.real(0, path % 4 < 2 ? 0.01 : 0) * Mat3::Identity();
      const Real before = point.state.plastic_volume;
      point.step(f), same.step(f);
      ASSERT_LE((point.stress - same.stress).norm(), 1e-13 * testing::sample_stiffness);
      ASSERT_NEAR(point.state.plastic_work, same.state.plastic_work, 1e-13 * testing::sample_stiffness);
      ASSERT_NEAR(point.state.plastic_volume, same.state.plastic_volume, 1e-13);
      ASSERT_NEAR(point.state.opened_volume, same.state.opened_volume, 1e-13);
      opened += point.state.opened_volume > 0;
      softened += point.state.plastic_volume > before;
      hardened += point.state.plastic_volume < before;
    }
  }
  EXPECT_GT(opened, 100);
  EXPECT_GT(softened, 100);
  EXPECT_GT(hardened, 100);
}

TEST(CohesiveCamClay, LinearElasticityIsTheLimitOfExponentialElasticity)
{
  CohesiveCamClay near = firn();
  near.bulk_modulus.reset();
  near.swelling_index = 1e6;
  near.reference_pressure = 1e6 * K;
  Dice dice(2);
  for (int path = 0; path < 50; ++path) {
    Point<CohesiveCamClay> point{.law = firn()}, limit{.law = near};
    for (int n = 0; n < 20; ++n) {
      const Mat3 f = Mat3::Identity() + dice.matrix(0.003) - 0.002 * Mat3::Identity();
      point.step(f), limit.step(f);
      ASSERT_LE((point.stress - limit.stress).norm(), 1e-6 * K);
    }
    ASSERT_GT(point.state.plastic_strain, 0);
  }
}

TEST(CohesiveCamClay, IsotropicCompressionFollowsTheHyperbolicSine)
{
  for (const int steps : {1, 10, 300}) {
    Point<CohesiveCamClay> point{.law = firn()};
    go(point, -0.5 * p0 / K, steps);
    EXPECT_NEAR(p_of(point), 0.5 * p0, 1e-10 * p0) << "elastic";
    go(point, -0.3 + 0.5 * p0 / K, steps);
    const Real p = p_of(point);
    EXPECT_GT(p, 5 * p0);
    EXPECT_NEAR(0.3, p / K + std::asinh(p / K) / xi - compacted, 1e-11);
    EXPECT_NEAR(-point.state.plastic_volume, std::asinh(p / K) / xi - compacted, 1e-11);
    go(point, 0.01, 1);
    EXPECT_NEAR(p_of(point), p - 0.01 * K, 1e-10 * K) << "unloads elastically";
  }
}

TEST(CohesiveCamClay, TensionIsCutAtTheApexSoftensAndEndsWhenTheCompactionIsLost)
{
  for (const int steps : {1, 10, 300}) {
    Point<CohesiveCamClay> point{.law = firn()};
    go(point, 0.999 * beta * p0 / K, steps);
    EXPECT_NEAR(p_of(point), -0.999 * beta * p0, 1e-10 * p0) << "elastic up to the apex";
    const Real extended = 0.6 * compacted + 0.4 * beta * p0 / K;
    go(point, extended - 0.999 * beta * p0 / K, steps);
    const Real p = p_of(point), dilated = point.state.plastic_volume;
    EXPECT_GT(dilated, 0);
    EXPECT_NEAR(extended, dilated - p / K, 1e-12);
    EXPECT_NEAR(p, -beta * K * std::sinh(xi * (compacted - dilated)), 1e-10 * p0) << "on the apex of the softer ellipse";
    EXPECT_LE(q_of(point), 1e-15 * G * steps);
    go(point, compacted + 0.1 - extended, steps);
    EXPECT_EQ(point.stress.norm(), 0);
    EXPECT_NEAR(point.state.plastic_volume, compacted, 1e-15);
    EXPECT_NEAR(point.state.opened_volume, 0.1, 1e-12);
    EXPECT_LE(point.law.yield(point.stress, point.state), 1e-9);
    go(point, -0.1 + 1e-6, steps);
    EXPECT_EQ(point.stress.norm(), 0) << "still open";
    go(point, -1e-6 - 0.05, steps);
    EXPECT_NEAR(0.05, p_of(point) / K + std::asinh(p_of(point) / K) / xi, 1e-11) << "compacts from nothing";
    EXPECT_EQ(point.state.opened_volume, 0);
  }
}

TEST(CohesiveCamClay, PlasticWorkOfTensionIsTheIntegralAlongTheApex)
{
  constexpr int steps = 20000;
  Point<CohesiveCamClay> point{.law = firn()};
  go(point, compacted + 0.01, steps);
  const Real work = beta * K / xi * (std::cosh(xi * compacted) - 1);  // of beta K sinh(xi a) over a
  EXPECT_NEAR(point.state.plastic_work, work, 1e-3 * work);
}

TEST(CohesiveCamClay, BrittleSnowFallsApartAtItsApexAndLosesWhatItHadStored)
{
  CohesiveCamClay law = firn();
  law.hardening_factor = 30;  // beta xi = 9: p0 falls nine times as fast as the tension
  Point<CohesiveCamClay> point{.law = law};
  go(point, 0.999 * beta * p0 / K, 1);
  const Real stored = 0.5 * std::pow(0.999 * beta * p0, 2) / K;
  go(point, 0.002 * beta * p0 / K, 1);
  EXPECT_EQ(point.stress.norm(), 0);
  EXPECT_NEAR(point.state.plastic_work, stored, 1e-9 * stored);
  EXPECT_NEAR(point.state.plastic_volume, std::asinh(p0 / K) / 30, 1e-15);
  EXPECT_NEAR(point.state.opened_volume, 1.001 * beta * p0 / K - std::asinh(p0 / K) / 30, 1e-12);
  go(point, 0.1, 3);
  EXPECT_NEAR(point.state.plastic_work, stored, 1e-9 * stored) << "pieces in flight dissipate nothing";
}

TEST(CohesiveCamClay, ExponentialHardeningSoftensInTensionWithoutEnd)
{
  const CohesiveCamClay law = chalk();
  for (const int steps : {10, 300}) {
    Point<CohesiveCamClay> point{.law = law};
    go(point, 0.3, steps);
    const Real kappa = *law.swelling_index, plastic = *law.compression_index - kappa, p = p_of(point);
    EXPECT_LT(p, 0);
    EXPECT_NEAR(0.3, -kappa * std::log1p(p / *law.reference_pressure) + point.state.plastic_volume, 1e-11);
    EXPECT_NEAR(p, -beta * law.preconsolidation_pressure * std::exp(-point.state.plastic_volume / plastic), 1e-9 * p0);
    EXPECT_EQ(point.state.opened_volume, 0);
  }
}

TEST(CohesiveCamClay, ShearAtConstantVolumeEndsInTheMiddleOfTheEllipse)
{
  for (const Real start : {0.1, 0.8}) {
    Point<CohesiveCamClay> point{.law = firn()};
    point.prestress(-start * p0 * Mat3::Identity());
    for (int n = 0; n < 4000; ++n)
      point.step(squeeze(-2e-3));
    const Real pc = point.constants.preconsolidation_at(point.state.plastic_volume);
    EXPECT_NEAR(p_of(point), (1 - beta) * pc / 2, 1e-5 * pc);
    EXPECT_NEAR(q_of(point), 1.2 / std::sqrt(1 + 2 * beta) * (1 + beta) * pc / 2, 1e-5 * pc);
    EXPECT_NEAR(p_of(point) / K - point.state.plastic_volume, start * p0 / K, 1e-9) << "constant volume";
  }
}

TEST(CohesiveCamClay, AnswersAnyTrialStateOnTheEllipseWithAssociatedFlow)
{
  Dice dice(3);
  int wet = 0, dry = 0, apart = 0;
  for (int n = 0; n < 60000; ++n) {
    CohesiveCamClay law = n % 3 ? firn() : chalk();
    law.critical_state_slope = dice.real(0.3, 2);
    law.cohesion_ratio = n % 7 == 0 ? 0 : dice.real(0, 1);
    if (law.hardening_factor)
      law.hardening_factor = std::pow(10, dice.real(-1, 1.5));
    Point<CohesiveCamClay> point{.law = law};
    const auto& c = point.constants;
    point.state.plastic_volume = c.rate > 0 ? dice.real(-3, 1) * c.compacted : dice.real(-1, 1) * c.plastic;
    const Real pc_before = c.preconsolidation_at(point.state.plastic_volume);
    const Real inside = -dice.real(-0.9 * law.cohesion_ratio, 0.9) * pc_before;  // mean stress
    point.state.elastic_left = elastic_left_of(dev(dice.symmetric(0.1 * pc_before)), c.shear, -c.compression_under(-inside));
    const Real size = std::pow(10, dice.real(-8, -1));
    const Mat3 H = dice.matrix(size);
    const auto before = point.state;
    const Sym3 trial = 0.5 * log1p(push_forward(H, before.elastic_left));
    point.strain(H);
    ASSERT_TRUE(point.stress.allFinite()) << n;
    const auto& now = point.state;
    const Real p = p_of(point), q = q_of(point), pc = c.preconsolidation_at(now.plastic_volume), M = law.critical_state_slope;
    const Real b = law.cohesion_ratio;
    ASSERT_LE(law.yield(point.stress, now), 1e-9 * (pc + K)) << n;
    ASSERT_GE(now.plastic_work, before.plastic_work);
    ASSERT_GE(now.plastic_strain, before.plastic_strain);
    if (now.opened_volume > 0 || (c.rate > 0 && pc == 0)) {
      ++apart;
      ASSERT_EQ(point.stress.norm(), 0);
      continue;
    }
    const Real compaction = before.plastic_volume - now.plastic_volume, sheared = now.plastic_strain - before.plastic_strain;
    ASSERT_NEAR(p, c.pressure(-(trace(trial) + compaction)), 1e-9 * (std::abs(p) + K * size + pc)) << n;
    if (std::abs(compaction) < 1e-9)
      continue;
    ++(compaction > 0 ? wet : dry);
    ASSERT_NEAR(((1 + 2 * b) * q * q / (M * M) + (p + b * pc) * (p - pc)) / (pc * pc), 0, 1e-6 * (1 + K * size / pc)) << n;
    const Real f_p = 2 * p - (1 - b) * pc, f_q = 2 * (1 + 2 * b) * q / (M * M);
    const Real scale = std::abs(compaction) * (std::abs(f_q) + 1e-3 * pc) + sheared * (std::abs(f_p) + 1e-3 * pc);
    ASSERT_NEAR(compaction * f_q, sheared * f_p, 1e-5 * scale) << n;
  }
  EXPECT_GT(wet, 5000);
  EXPECT_GT(dry, 5000);
  EXPECT_GT(apart, 1000);
}

TEST(CohesiveCamClay, PrestressMayBeTensionAndRaisesThePreconsolidationOutside)
{
  const Mat3 tension = 0.5 * beta * p0 * Mat3::Identity(), heavy = Vec3(-6e5, -6e5, -9e5).asDiagonal();
  for (const CohesiveCamClay& law : {firn(), chalk()}) {
    for (const Mat3& start : {Mat3(tension * (law.preconsolidation_pressure / p0)), Mat3(-4 * heavy / 10), heavy}) {
      Point<CohesiveCamClay> point{.law = law};
      point.prestress(start);
      EXPECT_LE(point.law.yield(start, point.state), 1e-9 * K);
      point.step(Mat3::Identity());
      EXPECT_LE((point.stress - start).norm(), 1e-10 * K);
      EXPECT_LE(point.state.plastic_strain, 1e-15) << "no flow but for rounding";
    }
    Point<CohesiveCamClay> raised{.law = law};
    raised.prestress(heavy);
    EXPECT_NEAR(raised.law.yield(heavy, raised.state), 0, 1e-9 * K) << "raised as little as bears it";
    Point<CohesiveCamClay> inside{.law = law};
    inside.prestress(tension * (law.preconsolidation_pressure / p0));
    EXPECT_EQ(inside.state.plastic_volume, 0);
  }
}

TEST(CohesiveCamClay, DividedStrengthLeavesPreconsolidationAndTension)
{
  CohesiveCamClay law = firn(), weak = law;
  weak.divide_strength(1.4);
  const auto tangent = [](Real slope) { return std::tan(std::asin(3 * slope / (6 + slope))); };
  EXPECT_NEAR(tangent(weak.critical_state_slope), tangent(1.2) / 1.4, 1e-14);
  EXPECT_EQ(weak.preconsolidation_pressure, p0);
  EXPECT_EQ(weak.cohesion_ratio, beta);
}

TEST(CohesiveCamClayRules, ContradictionsAreToldInWords)
{
  using Law = CohesiveCamClay;
  using ::testing::ElementsAre;
  EXPECT_TRUE(problems_of(firn(), [](Law&) {}).empty());
  EXPECT_TRUE(problems_of(chalk(), [](Law&) {}).empty());
  EXPECT_THAT(problems_of(firn(), [](Law& it) { it.cohesion_ratio = 1.5; }), ElementsAre("cohesion_ratio 1.5 is above 1"));
  EXPECT_THAT(problems_of(firn(), [](Law& it) { it.hardening_factor.reset(); }),
              ElementsAre("hardening is by hardening_factor or by compression_index: give one of them"));
  EXPECT_THAT(problems_of(firn(), [](Law& it) { it.hardening_factor.reset(), it.compression_index = 0.1; }),
              ElementsAre("compression_index needs swelling_index"));
  EXPECT_THAT(problems_of(firn(), [](Law& it) { it.reference_pressure = 1e4; }),
              ElementsAre("swelling_index and reference_pressure come together"));
  EXPECT_THAT(problems_of(chalk(), [](Law& it) { it.bulk_modulus = 1e6; }),
              ElementsAre("with swelling_index shear_modulus is the only other elastic constant"));
  EXPECT_THAT(problems_of(chalk(), [](Law& it) { it.swelling_index = 0.3; }),
              ElementsAre("compression_index 0.2 must be above swelling_index 0.3"));
}

}  // namespace
}  // namespace talus::cohesive_cam_clay_test
