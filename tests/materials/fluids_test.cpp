// Pressure and viscosity of the weakly compressible fluids, against their formulas.
#include <gtest/gtest.h>

#include "materials/herschel_bulkley.hpp"
#include "materials/newtonian.hpp"
#include "tests/materials/samples.hpp"

namespace talus::fluids_test {
namespace {

using testing::Dice;
using testing::Point;
using testing::rotation_about;

constexpr Real K = 2e6;
constexpr Real rounding = 1e-13;  // of a bulk modulus times differences from one, over some tens of operations

Newtonian oil(Real viscosity = 3)
{
  Newtonian law;
  law.density = 900;
  law.bulk_modulus = K;
  law.viscosity = viscosity;
  return law;
}
HerschelBulkley mud(Real yield_stress, Real consistency, Real flow_index)
{
  HerschelBulkley law;
  law.density = 1600;
  law.bulk_modulus = K;
  law.yield_stress = yield_stress;
  law.consistency = consistency;
  law.flow_index = flow_index;
  law.regularisation = 100;
  return law;
}

template <class L>
Point<L> point_of(const L& law)
{
  return {.law = law};
}
/// Pressure at volume ratio J, where no viscous stress is left.
template <class L>
Real resting_pressure(const L& law, Real J)
{
  auto point = point_of(law);
  point.step(std::cbrt(J) * Mat3::Identity());
  point.step(Mat3::Identity());
  EXPECT_EQ(dev(point.stress).norm(), 0);
  return -point.stress.trace() / 3;
}

Mat3 simple_shear(Real gamma)
{
  Mat3 f = Mat3::Identity();
  f(0, 1) = gamma;
  return f;
}
/// 2 D_xy dt of a step of simple shear: the logarithm of f f^T has this component.
Real logarithmic_shear(Real gamma) { return 4 * std::asinh(gamma / 2) / std::sqrt(4 + gamma * gamma); }

TEST(WeaklyCompressible, PressureFollowsTheCurveOfCole)
{
  for (const Real J : {0.5, 0.9, 0.99, 0.999999}) {
    EXPECT_NEAR(resting_pressure(oil(), J), K / 7 * (std::pow(J, -7) - 1), rounding * K * std::pow(J, -7)) << J;
    EXPECT_NEAR(resting_pressure(mud(10, 1, 1), J), K / 7 * (std::pow(J, -7) - 1), rounding * K * std::pow(J, -7)) << J;
  }
  Newtonian gas = oil();
  gas.exponent = 1.4;
  EXPECT_NEAR(resting_pressure(gas, 0.5), K / 1.4 * (std::pow(2.0, 1.4) - 1), rounding * K);
  gas.exponent = 1;
  EXPECT_NEAR(resting_pressure(gas, 0.5), K, rounding * K);
}

TEST(WeaklyCompressible, WithoutTensionTheFluidOpensFreelyAndClosesBeforePressureIsFelt)
{
  auto point = point_of(oil(0));
  point.step(1.1 * Mat3::Identity());
  EXPECT_EQ(point.stress.norm(), 0);
  point.step(1 / 1.05 * Mat3::Identity());
  EXPECT_EQ(point.stress.norm(), 0);
  point.step(1 / 1.05 * Mat3::Identity());
  const Real J = point.F.determinant();
  ASSERT_LT(J, 1);
  EXPECT_NEAR(-point.stress(0, 0), K / 7 * (std::pow(J, -7) - 1), rounding * K);
}

TEST(WeaklyCompressible, WithTensionTheCurveGoesOnBelowZero)
{
  Newtonian law = oil();
  law.tension = true;
  EXPECT_NEAR(resting_pressure(law, 1.01), K / 7 * (std::pow(1.01, -7) - 1), rounding * K);
  EXPECT_LT(resting_pressure(law, 1.01), -0.009 * K);
}

TEST(WeaklyCompressible, AnElasticStageSuspendsTheCutAtZero)
{
  auto point = point_of(oil(0));
  point.step(1.1 * Mat3::Identity(), true);
  EXPECT_NEAR(point.stress(0, 0), K / 7 * (1 - std::pow(1.1, -21)), rounding * K);
}

TEST(WeaklyCompressible, SpeedOfSoundIsTheSlopeOfPressureByDensity)
{
  Newtonian law = oil();
  law.tension = true;
  for (const Real J : {0.8, 1.0, 1.1}) {
    constexpr Real h = 1e-5;  // its square is the error
    const Real slope = (resting_pressure(law, J * (1 - h)) - resting_pressure(law, J * (1 + h))) /
                       (law.density / (J * (1 - h)) - law.density / (J * (1 + h)));
    EXPECT_NEAR(law.wave_speed(Mat3(std::cbrt(J) * Mat3::Identity()), {}) / std::sqrt(slope), 1, 1e-8);
  }
  EXPECT_NEAR(law.wave_speed(Mat3(Mat3::Identity()), {}), std::sqrt(K / 900), 1e-12 * std::sqrt(K / 900));
}

TEST(Newtonian, ShearStressIsViscosityTimesRateInManySteps)
{
  for (const Real rate : {1e-6, 1e-2, 1.0, 1e3})
    for (const Real gamma : {1e-6, 1e-3}) {
      auto point = point_of(oil());
      for (int n = 0; n < 1000; ++n) {
        point.step(simple_shear(gamma), false, gamma / rate);
        ASSERT_NEAR(point.stress(0, 1) / (3 * rate), 1, gamma * gamma + 1e-9);  // rounding of F - I of 1e-16 over gamma
        ASSERT_NEAR(point.stress(0, 1) / (3 * rate), logarithmic_shear(gamma) / gamma, 1e-9);
      }
      EXPECT_NEAR(point.state.plastic_work / (3 * rate * 1000 * gamma), 1, gamma * gamma + 1e-9);  // mu rate^2 times the time
    }
}

TEST(Newtonian, LargeStepOfShearHasTheRateOfItsLogarithm)
{
  for (const Real gamma : {0.1, 1.0, 10.0}) {
    auto point = point_of(oil());
    point.step(simple_shear(gamma), false, 0.5);
    EXPECT_NEAR(point.stress(0, 1), 3 * logarithmic_shear(gamma) / 0.5, 1e-12 * 3 * gamma);
  }
}

TEST(Newtonian, ShearOfATurnedFluidIsTurnedAndAPureRotationMakesNoStress)
{
  const Mat3 Q = rotation_about(Vec3(1, 2, 3), 1.1);
  auto turned = point_of(oil()), still = point_of(oil());
  for (const Real angle : {1e-3, 0.5, 3.0}) {
    turned.step(rotation_about(Vec3(3, -1, 2), angle));
    EXPECT_LE(turned.stress.norm(), rounding * K) << angle;
  }
  turned.step(Q * simple_shear(0.01) * Q.transpose());
  still.step(simple_shear(0.01));
  EXPECT_LE((turned.stress - Q * still.stress * Q.transpose()).norm(), rounding * K);
  EXPECT_NEAR(still.stress(0, 1), 3 * logarithmic_shear(0.01) / 1e-3, 1e-12 * 30);
}

TEST(Newtonian, VolumeViscosityResistsChangeOfVolumeButDoesNotPull)
{
  Newtonian law = oil();
  law.volume_viscosity = 50;
  const auto mean = [&](Real stretch, bool tension) {
    law.tension = tension;
    auto point = point_of(law);
    point.step(stretch * Mat3::Identity(), false, 1e-3);
    return point.stress.trace() / 3;
  };
  const auto viscous = [](Real stretch) { return 50 * 3 * std::log(stretch) / 1e-3; };
  const auto elastic = [](Real stretch) { return -K / 7 * (std::pow(stretch, -21) - 1); };
  EXPECT_NEAR(mean(0.99, false), elastic(0.99) + viscous(0.99), rounding * K);
  EXPECT_NEAR(mean(1.01, true), elastic(1.01) + viscous(1.01), rounding * K);
  EXPECT_EQ(mean(1.01, false), 0);
}

TEST(Newtonian, AStepWithoutDurationTakesTheRateAsItIs)
{
  const Mat3 F = Mat3::Identity(), rest = Mat3::Zero();
  Mat3 rate = Mat3::Zero();
  rate(0, 1) = 7;
  Newtonian law = oil();
  FluidHistory state;
  const Mat3 stress = law.update(Increment{F, rate, rest, 0, 0, false}, state, {});
  EXPECT_NEAR(stress(0, 1), 3 * 7, 1e-14 * 21);
  EXPECT_EQ(state.plastic_work, 0);
}

TEST(Newtonian, DiffusivityIsThatOfACompressionWave)
{
  Newtonian law = oil(3);
  law.volume_viscosity = 2;
  EXPECT_NEAR(law.diffusivity({}), (4.0 + 2) / 900, 1e-16);
}

/// Shear stress at a rate, sheared in steps so small that their rate is exact to 1e-12.
Real flow_stress(const HerschelBulkley& law, Real rate)
{
  constexpr Real gamma = 1e-6;
  const Mat3 F = Mat3::Identity(), none = Mat3::Zero();
  Mat3 H = Mat3::Zero();
  H(0, 1) = gamma;
  FluidHistory state;
  H *= rate / gamma;
  const Mat3 stress = law.update(Increment{F, H, none, gamma / rate, 0, false}, state, law.constants());
  EXPECT_NEAR(state.plastic_work, stress(0, 1) * gamma, 1e-10 * stress(0, 1) * gamma);
  return stress(0, 1);
}

TEST(HerschelBulkley, FlowCurveIsTheFormula)
{
  for (const Real n : {0.3, 0.5, 1.0})
    for (const Real rate : {0.01, 0.1, 1.0, 50.0, 1e4}) {
      const Real expected = 20 * (1 - std::exp(-100 * rate)) + 4 * std::pow(rate, n);
      EXPECT_NEAR(flow_stress(mud(20, 4, n), rate) / expected, 1, 1e-9) << n << " at " << rate;
    }
  EXPECT_NEAR(flow_stress(mud(20, 4, 1), 2), 20 + 4 * 2, 1e-9 * 28) << "Bingham: the regularisation has died away";
}

TEST(HerschelBulkley, WithoutYieldStressAndWithIndexOneItIsNewtonian)
{
  Dice dice(1);
  auto thick = point_of(mud(0, 3, 1));
  Newtonian law = oil(3);
  law.density = 1600;
  auto water = point_of(law);
  for (int n = 0; n < 100; ++n) {
    const Mat3 f = Mat3::Identity() + dice.matrix(0.02);
    thick.step(f);
    water.step(f);
    ASSERT_LE((thick.stress - water.stress).norm(), 1e-14 * (K + water.stress.norm()));
  }
}

TEST(HerschelBulkley, BelowYieldItCreepsWithABoundedViscosity)
{
  const HerschelBulkley law = mud(20, 4, 0.5);
  const Real limit = 20 * 100 + 4 * std::sqrt(100.0);  // tau_y m + k m^(1-n)
  EXPECT_NEAR(flow_stress(law, 1e-9) / 1e-9, limit, 1e-6 * limit);
  EXPECT_NEAR(law.viscosity(0, law.constants()), limit, 1e-12 * limit);
}

TEST(HerschelBulkley, ThickeningEndsAtTheHighestRate)
{
  HerschelBulkley law = mud(0, 4, 1.5);
  law.highest_rate = 100;
  EXPECT_NEAR(flow_stress(law, 25), 4 * 125, 1e-9 * 500);
  EXPECT_NEAR(flow_stress(law, 400), 4 * 10 * 400, 1e-9 * 16000);
}

TEST(HerschelBulkley, NoRateHasMoreViscosityThanTheStepIsBoundedFor)
{
  Dice dice(2);
  for (const Real n : {0.2, 0.7, 1.0, 1.8}) {
    HerschelBulkley law = mud(15, 2, n);
    if (n > 1)
      law.highest_rate = 30;
    const auto c = law.constants();
    const Real bound = law.diffusivity(c) * 1600 * 3 / 4;
    Real most = 0;
    for (int i = 0; i < 1000; ++i)
      most = std::max(most, law.viscosity(std::pow(10, dice.real(-12, 6)), c));
    EXPECT_LE(most, bound * (1 + 1e-14)) << n;
    EXPECT_GE(most, 0.9 * bound) << n << ": the bound should be close";
  }
}

TEST(HerschelBulkley, RulesAreToldInWords)
{
  const auto problems = [](Real n, std::optional<Real> highest) {
    HerschelBulkley law = mud(15, 2, n);
    law.highest_rate = highest;
    std::vector<std::string> found;
    law.check(found);
    return found;
  };
  using Problems = std::vector<std::string>;
  EXPECT_EQ(problems(1, {}), Problems{});
  EXPECT_EQ(problems(1.5, 10), Problems{});
  EXPECT_EQ(problems(1.5, {}), Problems{"flow_index 1.5 is above 1 and needs highest_rate: without it no step is short enough"});
  EXPECT_EQ(problems(0.5, 10), Problems{"highest_rate needs a flow_index above 1, here 0.5"});
}

template <class L>
void expect_dissipation(L law)
{
  Dice dice(3);
  law.tension = false;
  for (int path = 0; path < 1000; ++path) {
    auto point = point_of(law);
    for (int n = 0; n < 50; ++n) {
      const Real before = point.state.plastic_work;
      point.step(Mat3::Identity() + dice.matrix(n % 10 == 9 ? 0.1 : 0.005), false, std::pow(10, dice.real(-6, 0)));
      ASSERT_TRUE(point.stress.allFinite());
      ASSERT_GE(point.state.plastic_work, before);
      ASSERT_LE(point.stress.trace(), 1e-12 * K) << "pulls";
    }
  }
}
TEST(Newtonian, DissipatesAndDoesNotPullOnRandomPaths)
{
  Newtonian law = oil();
  law.volume_viscosity = 20;
  expect_dissipation(law);
}
TEST(HerschelBulkley, DissipatesAndDoesNotPullOnRandomPaths) { expect_dissipation(mud(20, 4, 0.4)); }

}  // namespace
}  // namespace talus::fluids_test
