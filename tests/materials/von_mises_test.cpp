#include "materials/von_mises.hpp"

#include <gtest/gtest.h>

#include "materials/laboratory/point_path.hpp"
#include "tests/materials/metals.hpp"

namespace talus::von_mises_test {
namespace {

using testing::Dice;
using testing::Point;
using testing::random_step;
using testing::rotation_about;
using testing::stiffened;
using testing::stretch;

constexpr Real machine = 1e-12;  // relative: rounding of some hundred operations
constexpr Real strength = 300e6, E = 200e9, nu = 0.3;

VonMises perfect()
{
  VonMises law;
  law.density = 7800;
  law.bulk_modulus = E / (3 * (1 - 2 * nu));
  law.shear_modulus = E / (2 * (1 + nu));
  law.yield_stress = strength;
  return law;
}
/// All that hardens, without rate.
VonMises hardening()
{
  VonMises law = perfect();
  law.hardening_modulus = 1e9;
  law.voce = VoceHardening{.saturation = 150e6, .exponent = 12};
  law.power = PowerHardening{.coefficient = 400e6, .exponent = 0.3};
  return law;
}
VonMises fast()
{
  VonMises law = hardening();
  law.rate = CowperSymonds{.reference_rate = 40, .exponent = 5};
  return law;
}
/// The same formula, written once more.
Real expected_strength(const VonMises& law, Real p, Real rate)
{
  Real s = strength + law.hardening_modulus * p;
  if (law.voce)
    s += law.voce->saturation * (1 - std::exp(-law.voce->exponent * p));
  if (law.power)
    s += law.power->coefficient * std::pow(p, law.power->exponent);
  return law.rate ? s * (1 + std::pow(rate / law.rate->reference_rate, 1 / law.rate->exponent)) : s;
}

TEST(VonMises, FlowStressFollowsTheHardening)
{
  for (const VonMises& law : {perfect(), hardening(), fast()}) {
    Point<VonMises> point{.law = law};
    for (int n = 0; n < 200; ++n) {
      const Real before = point.state.plastic_strain, dt = n % 2 ? 1e-3 : 1e-5;
      point.step(stretch(2e-3), false, dt);
      const Real p = point.state.plastic_strain, rate = (p - before) / dt;
      ASSERT_GT(p, before);
      ASSERT_NEAR(von_mises(point.stress) / expected_strength(law, p, rate), 1, machine);
      ASSERT_NEAR(law.flow_stress(p, rate) / expected_strength(law, p, rate), 1, machine);
    }
    EXPECT_NEAR(point.state.plastic_strain, 0.4 - von_mises(point.stress) / (3 * *law.shear_modulus), machine);
  }
}

TEST(VonMises, LinearHardeningIsExactForAnySteps)
{
  VonMises law = perfect();
  law.hardening_modulus = 5e9;
  for (const int steps : {1, 7, 300}) {
    Point<VonMises> point{.law = law};
    for (int n = 0; n < steps; ++n)
      point.step(stretch(0.3 / steps));
    const Real G = *law.shear_modulus, p = (3 * G * 0.3 - strength) / (3 * G + 5e9);
    EXPECT_NEAR(point.state.plastic_strain / p, 1, machine) << steps;
    EXPECT_NEAR(von_mises(point.stress) / (strength + 5e9 * p), 1, 100 * machine) << steps;  // rounding of the strain times 3G
    // The step that meets the yield surface counts from there, so that the work is exact as well.
    EXPECT_NEAR(point.state.plastic_work / (strength * p + 2.5e9 * p * p), 1, machine) << steps;
  }
}

TEST(VonMises, ClosedFormAndSolveAgree)
{
  VonMises closed = perfect(), solved = closed;
  closed.hardening_modulus = solved.hardening_modulus = 2e9;
  solved.voce = VoceHardening{.saturation = 1e-200, .exponent = 1};
  ASSERT_TRUE(closed.constants().closed_form);
  ASSERT_FALSE(solved.constants().closed_form);
  Dice dice(1);
  Point<VonMises> a{.law = closed}, b{.law = solved};
  for (int n = 0; n < 100; ++n) {
    const Mat3 f = Mat3::Identity() + dice.matrix(0.01);
    a.step(f);
    b.step(f);
    ASSERT_LE((a.stress - b.stress).norm(), 100 * machine * a.stress.norm());  // a hundred steps
  }
  EXPECT_GT(a.state.plastic_strain, 0.1);
}

TEST(VonMises, DynamicStrengthDoublesAtTheReferenceRate)
{
  VonMises law = stiffened(perfect());
  law.rate = CowperSymonds{.reference_rate = 40, .exponent = 5};
  for (const auto& [rate, factor] : {std::pair{40.0, 2.0}, {40.0 * 32, 3.0}, {40.0 / 32, 1.5}, {4e-9, 1.01}}) {
    Point<VonMises> point{.law = law};
    for (int n = 0; n < 5; ++n)
      point.step(stretch(1e-3), false, 1e-3 / rate);
    EXPECT_NEAR(von_mises(point.stress) / strength, factor, 1e-9) << rate;  // rounding of the strain times 3G
  }
}

TEST(VonMises, TensionTestReadsTheCauchyStress)
{
  const PointPath pull{
      .steps = 200,
      .time = 0.5,
      .controls = {.xx = Control{Controlled::strain_rate, 1}, .yy = Control{Controlled::stress, 0}, .zz = Control{Controlled::stress, 0}}};
  const VonMises law = fast();
  const auto rows = drive(make_material(law, 0, 1, "bar"), {&pull, 1}).rows;
  constexpr std::size_t p = 6;  // history: elastic_left, plastic_strain
  for (std::size_t n = 1; n < rows.size(); ++n) {
    const Real axial = rows[n].stress(0, 0), kirchhoff = axial * rows[n].F.determinant();
    EXPECT_NEAR(rows[n].history[p], std::max(std::log(rows[n].F(0, 0)) - kirchhoff / E, 0.0), 1e-9);  // of the driver, on lateral stress
    if (rows[n].history[p] > 0) {
      const Real rate = (rows[n].history[p] - rows[n - 1].history[p]) / (rows[n].time - rows[n - 1].time);
      EXPECT_NEAR(axial / expected_strength(law, rows[n].history[p], rate), 1, 1e-9);
    }
  }
  EXPECT_GT(rows.back().history[p], 0.49);
}

TEST(VonMises, CompressionDoesNotStrengthenTheCauchyStress)
{
  for (const Real volume : {0.7, 1.3}) {
    Point<VonMises> point{.law = perfect()};
    point.step(std::cbrt(volume) * Mat3::Identity());
    EXPECT_EQ(point.state.plastic_strain, 0);
    point.step(stretch(0.05));
    EXPECT_NEAR(von_mises(point.stress) / strength, 1, machine);
    EXPECT_NEAR(point.stress.trace() / 3, *point.law.bulk_modulus * std::log(volume) / volume, machine * *point.law.bulk_modulus);
    EXPECT_NEAR(point.state.plastic_work / (volume * strength * point.state.plastic_strain), 1, machine);  // by initial volume
  }
}

TEST(VonMises, FirstYieldOfPowerHardeningIsFoundThoughItsSlopeIsInfinite)
{
  VonMises law = perfect();
  law.power = PowerHardening{.coefficient = 400e6, .exponent = 0.2};
  for (const Real above : {1e-2, 1e-4, 1e-6, 1e-8}) {
    Point<VonMises> point{.law = law};
    point.step(stretch((1 + above) * strength / (3 * *law.shear_modulus)));
    // Nearly all of the excess becomes hardening: p = (excess / K)^(1/n), down to 1e-41.  The excess has the digits that 1 + strain left.
    const Real p = point.state.plastic_strain, gained = 400e6 * std::pow(p, 0.2) + 3 * *law.shear_modulus * p;
    EXPECT_NEAR(gained / (above * strength), 1, 1e-12 / above);
    EXPECT_NEAR(von_mises(point.stress) / expected_strength(law, p, 0), 1, machine);
  }
}

TEST(VonMises, PlasticWorkIsOfSecondOrderInTheStep)
{
  const auto work = [](int steps) {
    VonMises law = stiffened(perfect());
    law.voce = VoceHardening{.saturation = 150e6, .exponent = 12};
    Point<VonMises> point{.law = law};
    for (int n = 0; n < steps; ++n)
      point.step(stretch(0.2 / steps));
    return point.state.plastic_work;
  };
  const Real exact = strength * 0.2 + 150e6 * (0.2 - (1 - std::exp(-2.4)) / 12);
  EXPECT_NEAR((work(10) - exact) / (work(20) - exact), 4, 0.05);
  EXPECT_NEAR(work(1000) / exact, 1, 1e-6);
}

TEST(VonMises, AHundredThousandRandomStepsEndOnOrInsideTheYieldSurface)
{
  Dice dice(2);
  const VonMises law = fast(), slow_law = hardening();
  int flowing = 0;
  for (int n = 0; n < 100000; ++n) {
    Point<VonMises> point{.law = law};
    point.state.plastic_strain = n % 10 ? dice.real(0, 0.5) : 0;
    point.prestress(dice.symmetric(2 * strength));
    const Real before = point.state.plastic_strain, dt = std::pow(10.0, dice.real(-9, 0));
    const Mat3 f = random_step(dice), Q = dice.rotation();
    Point<VonMises> turned = point;
    point.step(f, false, dt);
    turned.step(Q * f, false, dt);
    ASSERT_TRUE(point.stress.allFinite());
    ASSERT_LE((turned.stress - Q * point.stress * Q.transpose()).norm(), 1e-9 * point.stress.norm() + machine * strength);
    const Real p = point.state.plastic_strain, q = von_mises(point.stress), work = point.state.plastic_work;
    const Real slow = expected_strength(slow_law, p, 0), slow_before = expected_strength(slow_law, before, 0);
    if (work > 0) {
      // The strain of the step, without the digits that p - before has lost: work is the mean of the strengths at its ends times it.
      const Real increment = work / (0.5 * (q / slow * slow_before + point.F.determinant() * q));
      ASSERT_NEAR(p, before + increment, machine * p);
      ASSERT_NEAR(q / expected_strength(law, p, increment / dt), 1, 1e-10) << n;
      ++flowing;
    } else {
      ASSERT_EQ(work, 0);
      ASSERT_EQ(p, before);
      ASSERT_LE(q / slow, 1 + 1e-10) << n;
    }
  }
  EXPECT_GT(flowing, 20000);
  EXPECT_LT(flowing, 90000);
}

TEST(VonMises, QuarterTurnInAnyNumberOfStepsKeepsPrincipalStresses)
{
  const Mat3 start = Vec3(-4e8, -2e8, -3e8).asDiagonal();
  for (const int steps : {1, 10, 100}) {
    Point<VonMises> point{.law = perfect()};
    point.prestress(start);
    for (int n = 0; n < steps; ++n)
      point.step(rotation_about(Vec3::UnitZ(), std::acos(0.0) / steps));
    EXPECT_LE((point.stress - Mat3(Vec3(-2e8, -4e8, -3e8).asDiagonal())).norm(), 1e-15 * steps * E);  // rounding of f - I times E
  }
}

TEST(VonMises, SimpleShearToTenDoesNotOscillate)
{
  for (const bool elastic : {true, false}) {
    Point<VonMises> point{.law = perfect()};
    Mat3 f = Mat3::Identity();
    f(0, 1) = 10.0 / 1000;
    for (int n = 0; n < 1000; ++n) {
      point.step(f, elastic);
      if (!elastic && n > 0) {
        EXPECT_NEAR(point.stress(0, 1) * std::sqrt(3.0) / strength, 1, 1e-3);  // elastic strain turns by its own size
      }
    }
    if (elastic) {  // rounding times condition 1e4 of the left tensor
      EXPECT_NEAR(point.stress(0, 1), 4 * *point.law.shear_modulus * std::asinh(5.0) / std::sqrt(104.0), 1e-9 * *point.law.shear_modulus);
    }
  }
}

}  // namespace
}  // namespace talus::von_mises_test
