// A solid that flows above its yield stress, against closed forms of shear that starts, goes on, stops and rests.
#include "materials/elastic_herschel_bulkley.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/materials/samples.hpp"

namespace talus::elastic_herschel_bulkley_test {
namespace {

using testing::Dice;
using testing::Point;

constexpr Real shear_modulus = 4e6, yield_stress = 400;

/// Stiff mud: its elastic strains, squared, are below 1e-6.
ElasticHerschelBulkley mud(Real consistency, Real flow_index)
{
  ElasticHerschelBulkley law;
  law.density = 1600;
  law.shear_modulus = shear_modulus;
  law.bulk_modulus = 2e7;
  law.yield_stress = yield_stress;
  law.consistency = consistency;
  law.flow_index = flow_index;
  return law;
}
constexpr std::array indices{0.3, 0.5, 0.8, 1.0, 1.6, 2.0, 3.0};

Real tau_of(const Mat3& stress) { return std::sqrt(second_invariant(stress)); }
Mat3 shear_by(Real angle)
{
  Mat3 f = Mat3::Identity();
  f(0, 1) = angle;
  return f;
}
/// Shears from rest at a rate [1/s].
Point<ElasticHerschelBulkley> sheared(const ElasticHerschelBulkley& law, Real rate, Real dt, int steps)
{
  Point<ElasticHerschelBulkley> point{.law = law};
  for (int i = 0; i < steps; ++i)
    point.step(shear_by(rate * dt), false, dt);
  return point;
}

TEST(ElasticHerschelBulkley, SteadySimpleShearHasTheStressOfTheFluidAtStepsOfAnyLength)
{
  for (const Real n : indices) {
    for (const Real rate : {0.1, 1.0, 10.0}) {
      const Real viscous = 250, k = viscous * std::pow(rate, -n), expected = yield_stress + viscous;
      for (const Real angle : {2e-5, 1e-4}) {  // of a step
        const auto point = sheared(mud(k, n), rate, angle / rate, angle > 5e-5 ? 4000 : 20000);
        // What the history still has of the start falls with the strain over expected / G, and turned elastic strain adds its square.
        EXPECT_NEAR(point.stress(0, 1), expected, 1e-6 * expected) << n << ' ' << rate << ' ' << angle;
        EXPECT_NEAR(tau_of(point.stress), expected, 1e-6 * expected) << n << ' ' << rate << ' ' << angle;
      }
    }
  }
}

TEST(ElasticHerschelBulkley, EveryStepEndsOnTheFlowCurve)
{
  Dice dice(1);
  int flowing = 0, resting = 0;
  for (const Real n : indices) {
    for (int path = 0; path < 60; ++path) {
      Point<ElasticHerschelBulkley> point{.law = mud(std::pow(10, dice.real(0, 3)), n)};
      for (int i = 0; i < 40; ++i) {
        const auto before = point.state;
        const Real dt = std::pow(10, dice.real(-7, 2));
        point.step(Mat3::Identity() + dice.matrix(std::pow(10, dice.real(-5, -1))), false, dt);
        ASSERT_TRUE(point.stress.allFinite());
        ASSERT_GE(point.state.plastic_strain, before.plastic_strain);
        ASSERT_GE(point.state.plastic_work, before.plastic_work);
        const Real m = std::numbers::sqrt3 * (point.state.plastic_strain - before.plastic_strain), tau = tau_of(point.stress);
        const Real trial = tau + shear_modulus / point.F.determinant() * m;
        const Real rounding = 1e-11 * (shear_modulus + trial);  // sums of strains of up to ten
        if (m > 0) {
          ++flowing;
          const Real viscous = point.law.consistency * std::pow(m / dt, n);
          // The difference of two plastic strains, of up to ten, has 1e-15: so much of the rate is not known.
          const Real unknown = viscous * n * 1e-14 * (1 + point.state.plastic_strain) / m;
          ASSERT_NEAR(tau, yield_stress + viscous, rounding + unknown) << n << ' ' << dt << ' ' << m;
        } else {
          ++resting;
          ASSERT_LE(tau, yield_stress + rounding);
        }
      }
    }
  }
  EXPECT_GT(flowing, 8000);
  EXPECT_GT(resting, 100);
}

/// The relation of stress and plastic rate is that of von Mises with the rate factor of Cowper and Symonds: D and q follow from k and n.
TEST(ElasticHerschelBulkley, IsVonMisesWithTheRateFactorOfTheSameCurve)
{
  for (const Real n : {0.3, 0.5, 1.0, 1.6}) {
    const ElasticHerschelBulkley law = mud(120, n);
    VonMises metal;
    metal.density = law.density;
    metal.shear_modulus = law.shear_modulus;
    metal.bulk_modulus = law.bulk_modulus;
    metal.yield_stress = std::numbers::sqrt3 * law.yield_stress;
    metal.rate =
        CowperSymonds{.reference_rate = std::pow(law.yield_stress / law.consistency, 1 / n) * std::numbers::inv_sqrt3, .exponent = 1 / n};
    Dice dice(2);
    Point<ElasticHerschelBulkley> mine{.law = law};
    Point<VonMises> other{.law = metal};
    for (int i = 0; i < 300; ++i) {
      const Mat3 f = Mat3::Identity() + dice.matrix(i % 10 == 9 ? 0.02 : 1e-3);
      const Real dt = std::pow(10, dice.real(-5, 0));
      mine.step(f, false, dt);
      other.step(f, false, dt);
      ASSERT_LE((mine.stress - other.stress).norm(), 1e-11 * shear_modulus) << n;  // twice the root finder, on sums of strains
      ASSERT_NEAR(mine.state.plastic_strain, other.state.plastic_strain, 1e-11 * (1 + other.state.plastic_strain));
    }
    EXPECT_GT(mine.state.plastic_strain, 0.1);
  }
}

TEST(ElasticHerschelBulkley, BinghamOverstressDecaysExponentiallyWithTheTimeOfViscosityOverShearModulus)
{
  constexpr Real k = 4e3, rate = 0.5, time = k / shear_modulus;
  Real last = 0;
  for (const int per_time : {200, 400}) {  // steps within the time of decay
    const Real dt = time / per_time;
    auto point = sheared(mud(k, 1), rate, 1e-2 * time, 4000);
    const Real over = tau_of(point.stress) - yield_stress;
    ASSERT_NEAR(over, k * rate, 1e-5 * k * rate);
    Real worst = 0;
    for (int i = 1; i <= 3 * per_time; ++i) {
      point.step(Mat3::Identity(), false, dt);
      worst = std::max(worst, std::abs((tau_of(point.stress) - yield_stress) / over - std::exp(-dt * i / time)));
    }
    EXPECT_LT(worst, 0.3 * dt / time);  // backward Euler: half the step times x exp(-x), at most 1/e
    if (last > 0) {
      EXPECT_NEAR(last / worst, 2, 0.02);
    }
    last = worst;
    for (int i = 0; i < 40 * per_time; ++i)
      point.step(Mat3::Identity(), false, dt);
    EXPECT_NEAR(tau_of(point.stress), yield_stress, 1e-11 * shear_modulus);  // exp(-40) is nothing; strain of 1e-4 is known to 1e-16
  }
}

TEST(ElasticHerschelBulkley, StressAfterTheStopFallsToTheYieldStressAndStays)
{
  for (const Real n : indices) {
    auto point = sheared(mud(200, n), 2, 1e-4, 3000);
    const Real start = tau_of(point.stress);
    ASSERT_GT(start, 1.3 * yield_stress);
    Real before = start;
    for (int i = 0; i < 200; ++i) {
      point.step(Mat3::Identity(), false, 1e-4);
      ASSERT_LE(tau_of(point.stress), before + 1e-11 * shear_modulus);
      ASSERT_GE(tau_of(point.stress), yield_stress - 1e-11 * shear_modulus);
      before = tau_of(point.stress);
    }
    // Shear-thickening flow stops in finite time, do / dt = -G (o / k)^(1/n); shear-thinning flow never ends, so the steps grow.
    for (int i = 0; i < 200; ++i)
      point.step(Mat3::Identity(), false, std::pow(10, 0.3 * i));
    EXPECT_NEAR(tau_of(point.stress), yield_stress, 1e-10 * shear_modulus) << n;
  }
}

TEST(ElasticHerschelBulkley, OverstressOfPowerLawsDecaysByItsOwnLaw)
{
  for (const Real n : {0.5, 2.0}) {
    const Real k = 200, dt = 1e-8;
    auto point = sheared(mud(k, n), 2, 1e-4, 3000);
    const Real start = tau_of(point.stress) - yield_stress;
    const Real scale = k / shear_modulus * std::pow(start / k, 1 - 1 / n);  // time of decay at first [s]
    const int steps = static_cast<int>(0.5 * scale / dt);
    for (int i = 0; i < steps; ++i)
      point.step(Mat3::Identity(), false, dt);
    // do / dt = -G (o / k)^(1/n) with o = start at the time 0.
    const Real power = 1 - 1 / n, expected = start * std::pow(1 - power * dt * steps / scale, 1 / power);
    EXPECT_NEAR(tau_of(point.stress) - yield_stress, expected, 3 * dt / scale * start) << n;
    EXPECT_LT(expected, 0.8 * start);
  }
}

TEST(ElasticHerschelBulkley, BelowYieldNothingDriftsInManySteps)
{
  for (const Real n : {0.5, 1.0, 2.0}) {
    Point<ElasticHerschelBulkley> point{.law = mud(80, n)};
    point.step(shear_by(0.99 * yield_stress / shear_modulus));
    const Mat3 stress = point.stress;
    const auto state = point.state;
    for (int i = 0; i < 100000; ++i)
      point.step(Mat3::Identity());
    EXPECT_EQ((point.stress - stress).norm(), 0);
    EXPECT_EQ(point.state.plastic_strain, 0);
    EXPECT_EQ(point.state.plastic_work, 0);
    EXPECT_EQ(point.state.elastic_left[3], state.elastic_left[3]);
  }
}

/// Sheared back and forth below yield it is where it was, without work: 1e5 steps of rounding.
TEST(ElasticHerschelBulkley, CyclesBelowYieldAreElastic)
{
  Point<ElasticHerschelBulkley> point{.law = mud(80, 0.5)};
  const Real angle = 0.9 * yield_stress / shear_modulus;
  for (int cycle = 0; cycle < 50000; ++cycle) {
    point.step(shear_by(angle));
    point.step(shear_by(-angle));
  }
  EXPECT_NEAR(point.stress.norm(), 0, 1e-6 * yield_stress);
  EXPECT_EQ(point.state.plastic_strain, 0);
}

TEST(ElasticHerschelBulkley, StressTurnsWithABodyThatFlowsAndSpins)
{
  for (const Real n : indices) {
    Point<ElasticHerschelBulkley> still{.law = mud(300, n)}, turning{.law = mud(300, n)};
    Mat3 Q = Mat3::Identity();
    for (int i = 0; i < 500; ++i) {
      const Mat3 f = shear_by(1e-3), turned = testing::rotation_about(Vec3(1, 2, 3), 0.1 * (i + 1));
      still.step(f);
      turning.step(turned * f * Q.transpose());
      Q = turned;
    }
    ASSERT_GT(tau_of(still.stress), yield_stress);
    EXPECT_LE((turning.stress - Q * still.stress * Q.transpose()).norm(), 1e-11 * shear_modulus);
    EXPECT_NEAR(turning.state.plastic_work, still.state.plastic_work, 1e-9 * still.state.plastic_work);
  }
}

/// In steady shear the work of the stress is all dissipated; after the stop the elastic energy of what relaxes.
TEST(ElasticHerschelBulkley, PlasticWorkIsTheWorkOfTheStressAndThenTheElasticEnergyThatIsLost)
{
  for (const Real n : {0.5, 1.0, 1.6}) {
    constexpr Real rate = 2, dt = 1e-4;
    auto point = sheared(mud(200, n), rate, dt, 3000);
    const Real before = point.state.plastic_work, stress = yield_stress + 200 * std::pow(rate, n);
    for (int i = 0; i < 1000; ++i)
      point.step(shear_by(rate * dt), false, dt);
    EXPECT_NEAR(point.state.plastic_work - before, stress * rate * dt * 1000, 1e-6 * stress * rate * dt * 1000) << n;
    const Real work = point.state.plastic_work, tau = tau_of(point.stress);
    for (int i = 0; i < 50; ++i)
      point.step(Mat3::Identity(), false, 1e-5);
    const Real left = tau_of(point.stress), lost = (tau * tau - left * left) / (2 * shear_modulus);
    EXPECT_GT(lost, 1e-3);
    EXPECT_NEAR(point.state.plastic_work - work, lost, 1e-6 * lost + 1e-12 * work) << n;
  }
}

TEST(ElasticHerschelBulkley, WithoutConsistencyNoStressExceedsTheYieldStress)
{
  Dice dice(3);
  Point<ElasticHerschelBulkley> point{.law = mud(0, 0.5)};
  for (int i = 0; i < 200; ++i) {
    point.step(Mat3::Identity() + dice.matrix(0.01), false, 1e-9);
    ASSERT_LE(tau_of(point.stress), yield_stress + 1e-11 * shear_modulus);
  }
  EXPECT_GT(point.state.plastic_strain, 0.1);
}

TEST(ElasticHerschelBulkley, WithoutYieldStressItIsAFluidThatRelaxesToPressure)
{
  ElasticHerschelBulkley law = mud(50, 0.5);
  law.yield_stress = 0;
  auto point = sheared(law, 4, 2e-5, 4000);
  EXPECT_NEAR(point.stress(0, 1), 100, 1e-4);  // k sqrt(g)
  for (int i = 0; i < 60; ++i)
    point.step(Mat3::Identity(), false, std::pow(10, i));
  EXPECT_NEAR(tau_of(point.stress), 0, 1e-10 * shear_modulus);
}

TEST(ElasticHerschelBulkley, ElasticConstantsComeAsAPair)
{
  EXPECT_EQ(testing::problems_of(mud(1, 1), [](auto&) {}), testing::Problems{});
  EXPECT_EQ(testing::problems_of(mud(1, 1), [](auto& law) { law.youngs_modulus = 1e7; }).size(), 1u);
}

}  // namespace
}  // namespace talus::elastic_herschel_bulkley_test
