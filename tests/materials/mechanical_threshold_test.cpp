// The mechanical threshold stress: strength by its formula, evolution and heating against an integration of their equations.
#include "materials/mechanical_threshold.hpp"

#include <gtest/gtest.h>

#include "tests/materials/metals.hpp"

namespace talus::mechanical_threshold_test {
namespace {

using testing::annealed_copper;
using testing::Dice;
using testing::Point;
using testing::random_step;
using testing::stiffened;
using testing::stretch;

constexpr Real MPa = 1e6;

/// 4340 steel has both barriers: constants of the first as in the material files of Uintah (Goto et al. 2000).
MechanicalThreshold two_barriers()
{
  MechanicalThreshold law = annealed_copper();
  law.intrinsic =
      IntrinsicBarrier{.threshold = 1341e6, .activation_energy = 1.161, .activation_rate = 1e13, .activation_p = 0.5, .activation_q = 1.5};
  law.hardening_by_temperature = 0.5e6;
  law.initial_threshold = 100e6;
  return law;
}

/// The formulas, written once more.
Real softening(const ThresholdMetal& m, Real T)
{
  return 1 - m.shear_loss / (std::exp(m.shear_temperature / T) - 1) / m.shear_at_zero_kelvin;
}
Real energy(const ThresholdMetal& m, Real T) { return m.boltzmann_over_burgers_cubed * T / (softening(m, T) * m.shear_at_zero_kelvin); }
Real share(Real a, Real p, Real q) { return a >= 1 ? 0 : a <= 0 ? 1 : std::pow(1 - std::pow(a, 1 / q), 1 / p); }
Real strength(const ThresholdMetal& m, Real sigma_e, Real rate, Real T)
{
  Real thermal = sigma_e * share(energy(m, T) / m.activation_energy * std::log(m.activation_rate / rate), m.activation_p, m.activation_q);
  if (const auto& i = m.intrinsic)
    thermal +=
        i->threshold * share(energy(m, T) / i->activation_energy * std::log(i->activation_rate / rate), i->activation_p, i->activation_q);
  return m.athermal_stress + thermal * softening(m, T);
}
Real saturation(const ThresholdMetal& m, Real rate, Real T)
{
  return m.saturation_stress * std::pow(rate / m.saturation_rate, energy(m, T) / m.saturation_energy);
}
Real hardening(const ThresholdMetal& m, Real sigma_e, Real rate, Real T)
{
  const Real theta_0 = m.hardening_modulus + m.hardening_by_log_rate * std::log(rate) + m.hardening_by_root_rate * std::sqrt(rate) -
                       m.hardening_by_temperature * T;
  return theta_0 * (1 - std::tanh(m.hardening_shape * sigma_e / saturation(m, rate, T)) / std::tanh(m.hardening_shape));
}

/// sigma_e [Pa] and temperature [K] after a plastic strain at a constant rate, by Runge & Kutta of fourth order.
std::pair<Real, Real> integrated(const ThresholdMetal& m, Real sigma_e, Real T, Real rate, Real strain)
{
  constexpr int steps = 4000;
  const Real h = strain / steps, heat = m.heat_fraction / (m.density * m.specific_heat);
  const auto slope = [&](Real s, Real t) { return std::pair{hardening(m, s, rate, t), heat * strength(m, s, rate, t)}; };
  for (int n = 0; n < steps; ++n) {
    const auto [s1, t1] = slope(sigma_e, T);
    const auto [s2, t2] = slope(sigma_e + h / 2 * s1, T + h / 2 * t1);
    const auto [s3, t3] = slope(sigma_e + h / 2 * s2, T + h / 2 * t2);
    const auto [s4, t4] = slope(sigma_e + h * s3, T + h * t3);
    sigma_e += h / 6 * (s1 + 2 * s2 + 2 * s3 + s4);
    T += h / 6 * (t1 + 2 * t2 + 2 * t3 + t4);
  }
  return {sigma_e, T};
}

/// A point that has flowed at a constant rate; elastic strain is 1e-6 of what it is.
Point<MechanicalThreshold> flowed(const MechanicalThreshold& law, Real rate, Real strain, int steps)
{
  const MechanicalThreshold stiff = stiffened(law);
  Point<MechanicalThreshold> point{.law = stiff, .state = stiff.initial_state()};
  for (int n = 0; n < steps; ++n)
    point.step(stretch(strain / steps), false, strain / steps / rate);
  return point;
}

TEST(MechanicalThreshold, FlowStressOfCopperMatchesTheTable)
{
  // Rows: rates 1e-3, 1e3, 1e5 1/s.  Columns: sigma_e 0, 200, 600 MPa at 77 K, then at 298, 718 and 1000 K.
  constexpr std::array<std::array<Real, 12>, 3> table{{
      {40.0000, 232.6531, 617.9593, 40.0000, 201.5614, 524.6841, 40.0000, 141.7836, 345.3507, 40.0000, 104.0223, 232.0669},
      {40.0000, 236.2136, 628.6408, 40.0000, 215.0256, 565.0769, 40.0000, 172.2565, 436.7694, 40.0000, 143.7348, 351.2045},
      {40.0000, 237.4053, 632.2158, 40.0000, 219.5930, 578.7790, 40.0000, 182.9907, 468.9721, 40.0000, 158.3265, 394.9795},
  }};
  const MechanicalThreshold law = annealed_copper();
  for (std::size_t rate = 0; rate < 3; ++rate)
    for (std::size_t k = 0; k < 12; ++k) {
      const Real sigma_e = std::array{0.0, 200.0, 600.0}[k % 3] * MPa, T = std::array{77.0, 298.0, 718.0, 1000.0}[k / 3];
      EXPECT_NEAR(law.flow_stress(sigma_e / law.saturation_stress, std::array{1e-3, 1e3, 1e5}[rate], T) / MPa, table[rate][k], 0.5001e-4);
    }
}

TEST(MechanicalThreshold, FlowStressOfTwoBarriersIsThatOfTheFormula)
{
  const MechanicalThreshold law = two_barriers();
  for (const Real sigma_e : {0.0, 3e8, 9e8})
    for (const Real rate : {1e-4, 1.0, 1e6, 1e9, 1e14})
      for (const Real T : {50.0, 298.0, 900.0}) {
        const Real expected = strength(law, sigma_e, rate, T);
        EXPECT_NEAR(law.flow_stress(sigma_e / law.saturation_stress, rate, T), expected, 1e-12 * expected)
            << sigma_e << " " << rate << " " << T;
      }
}

TEST(MechanicalThreshold, FlowStressHasItsLimits)
{
  const MechanicalThreshold law = two_barriers();
  EXPECT_EQ(law.flow_stress(0.5, 0, 298), law.athermal_stress) << "at rest heat passes every barrier";
  EXPECT_EQ(law.flow_stress(0.5, 1e-200, 298), law.athermal_stress);
  EXPECT_EQ(law.flow_stress(0.5, 1e13, 298), law.flow_stress(0.5, 1e30, 298)) << "beyond both rates heat is no help";
  EXPECT_EQ(law.flow_stress(0.5, 1e13, 298), law.threshold(0.5, 298));
  EXPECT_NEAR(law.threshold(0.5, 298), 40e6 + (1341e6 + 385e6) * softening(law, 298), 1e-12 * law.threshold(0.5, 298));
  EXPECT_NEAR(law.flow_stress(0.5, 1, 3000), law.athermal_stress, 1e-9) << "where mu(T) ends";
}

TEST(MechanicalThreshold, EvolutionAtOneTemperatureIsExactInAnyNumberOfSteps)
{
  MechanicalThreshold law = two_barriers();
  law.heat_fraction = 0;
  for (const Real rate : {1e-3, 1e2, 1e5})
    for (const Real strain : {0.02, 0.3, 3.0}) {
      const Real expected = integrated(law, law.initial_threshold, 298, rate, strain).first;
      for (const int steps : {1, 7, 300}) {
        const auto point = flowed(law, rate, strain, steps);
        // The elastic strain, 1e-8, is missing in the plastic one of the first step.
        EXPECT_NEAR(point.state.threshold_ratio * law.saturation_stress, expected, 1e-6 * expected)
            << rate << " " << strain << " " << steps;
        EXPECT_NEAR(von_mises(point.stress), strength(law, expected, rate, 298), 1e-6 * von_mises(point.stress));
        EXPECT_NEAR(point.state.plastic_strain, strain, 1e-7);
      }
    }
}

TEST(MechanicalThreshold, ThresholdSaturatesAtTheStressOfRateAndTemperature)
{
  for (const Real T : {77.0, 298.0, 718.0})
    for (const Real rate : {1e-3, 1e5})
      for (const Real start : {0.0, 760e6}) {  // from below, and from above, where it recovers
        MechanicalThreshold law = annealed_copper();
        law.heat_fraction = 0;
        law.initial_temperature = T;
        law.initial_threshold = start;
        const Real expected = saturation(law, rate, T);
        Real before = start, strain = 0;
        for (Real reached : {0.1, 1.0, 10.0, 100.0}) {
          const Real now = flowed(law, rate, reached, 50).state.threshold_ratio * law.saturation_stress;
          const Real upwards = start < expected ? 1 : -1;
          EXPECT_GE(upwards * (now - before), -1e-12 * expected);
          EXPECT_GE(upwards * (expected - now), -1e-9 * expected);
          before = now, strain = reached;
        }
        EXPECT_EQ(strain, 100);
        EXPECT_NEAR(before, expected, 1e-9 * expected) << T << " " << rate << " " << start;
      }
}

TEST(MechanicalThreshold, AdiabaticFlowConvergesToTheSolutionInFirstOrder)
{
  for (const Real rate : {1e-2, 1e3, 1e5}) {
    const MechanicalThreshold law = annealed_copper();
    const auto [sigma_e, T] = integrated(law, 0, 298, rate, 1.0);
    std::array<Real, 3> threshold_error{}, heat_error{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto state = flowed(law, rate, 1.0, 100 << k).state;
      threshold_error[k] = std::abs(state.threshold_ratio * law.saturation_stress - sigma_e) / sigma_e;
      heat_error[k] = std::abs(state.temperature - T) / (T - 298);
    }
    EXPECT_LT(threshold_error[0], 1e-3);
    EXPECT_LT(heat_error[0], 1e-3);
    EXPECT_NEAR(threshold_error[1] / threshold_error[2], 2, 0.1) << rate;
    EXPECT_LT(heat_error[2], 0.6 * heat_error[1]) << rate;
  }
}

TEST(MechanicalThreshold, TemperatureRisesByTheShareOfThePlasticWork)
{
  for (const Real fraction : {0.0, 0.5, 0.9, 1.0}) {
    MechanicalThreshold law = annealed_copper();
    law.heat_fraction = fraction;
    Point<MechanicalThreshold> point{.law = law, .state = law.initial_state()};
    Real work = 0,
         lost = 0;  // of all stress, at constant volume, and what of it is not stored; from the tenth step on, all of them plastic
    const auto stored = [&] { return von_mises(point.stress) * von_mises(point.stress) / (6 * 46e9); };
    for (int n = 0; n < 1000; ++n) {
      const Mat3 before = point.stress;
      const Real lost_before = point.state.plastic_work + stored();
      point.step(stretch(1e-3), false, 1e-7);
      if (n >= 10) {
        work += 0.5 * 1e-3 * (before(0, 0) + point.stress(0, 0) - before(1, 1) - point.stress(1, 1));
        lost += point.state.plastic_work + stored() - lost_before;
      }
    }
    EXPECT_NEAR(lost, work, 1e-5 * work) << "second order in the steps";
    EXPECT_NEAR(point.state.temperature - 298, fraction * point.state.plastic_work / (8960 * 383), 1e-9);
  }
}

TEST(MechanicalThreshold, RandomStepsEndOnTheStrengthOrBelowIt)
{
  Dice dice(1);
  MechanicalThreshold law = two_barriers();
  law.mie_gruneisen = testing::copper_shock;
  const Real G = *law.shear_modulus;
  int flowing = 0, elastic = 0;
  for (int n = 0; n < 30000; ++n) {
    Point<MechanicalThreshold> point{.law = law, .state = law.initial_state()};
    point.state.threshold_ratio = n % 10 ? dice.real(0, 1.2) : 0;
    point.state.temperature = dice.real(20, 1300);
    point.prestress(dice.symmetric(5e8));
    const auto start = point.state;
    const Real dt = std::pow(10.0, dice.real(-10, -2));
    const Mat3 f = random_step(dice), Q = dice.rotation();
    Point<MechanicalThreshold> turned = point;
    point.step(f, false, dt);
    turned.step(Q * f, false, dt);
    const auto& s = point.state;
    const Real q = von_mises(point.stress);
    ASSERT_TRUE(point.stress.allFinite() && std::isfinite(s.temperature) && std::isfinite(s.internal_energy) &&
                std::isfinite(s.threshold_ratio));
    ASSERT_LE((turned.stress - Q * point.stress * Q.transpose()).norm(), 1e-9 * point.stress.norm() + 1e-12 * G) << n;
    ASSERT_GE(s.plastic_work, 0);
    ASSERT_GE(s.threshold_ratio, 0);
    ASSERT_NEAR(s.temperature, start.temperature + 0.9 * s.plastic_work / (8960 * 383), 1e-12 * s.temperature);
    if (s.plastic_strain > 0) {
      ASSERT_NEAR(q, law.flow_stress(s.threshold_ratio, s.plastic_strain / dt, s.temperature), 1e-9 * q + 1e-12 * G) << n;
      ++flowing;
    } else {
      ASSERT_EQ(s.threshold_ratio, start.threshold_ratio);
      ASSERT_LE(q, law.flow_stress(s.threshold_ratio, 1e-12 / dt, s.temperature) * (1 + 1e-9));  // what is elastic would flow less
      ++elastic;
    }
  }
  EXPECT_GT(flowing, 10000);
  EXPECT_GT(elastic, 3000);
}

TEST(MechanicalThreshold, PressureIsThatOfJohnsonCookWithTheSameCurve)
{
  MechanicalThreshold law = annealed_copper();
  JohnsonCook other = testing::copper();
  law.mie_gruneisen = other.mie_gruneisen = testing::copper_shock;
  Point<MechanicalThreshold> a{.law = law};
  Point<JohnsonCook> b{.law = other};
  for (const Real size : {0.98, 0.9, 1.05, 1.2}) {
    a.step(size * Mat3::Identity());
    b.step(size * Mat3::Identity());
    EXPECT_EQ((a.stress - b.stress).norm(), 0);
    EXPECT_EQ(a.state.internal_energy, b.state.internal_energy);
    EXPECT_EQ(a.law.wave_speed(a.F, a.constants), b.law.wave_speed(b.F, b.constants));
  }
}

TEST(MechanicalThreshold, StoresEnergyOnlyWithAnEquationOfState)
{
  MechanicalThreshold law = annealed_copper();
  EXPECT_EQ(law.kind().index(), 0u);
  law.mie_gruneisen = testing::copper_shock;
  EXPECT_EQ(law.kind().index(), 1u);
}

TEST(MechanicalThreshold, ParametersWithoutStrengthAreRefused)
{
  const auto problems = [](auto&& change) { return testing::problems_of(annealed_copper(), change); };
  EXPECT_TRUE(problems([](MechanicalThreshold&) {}).empty());
  EXPECT_EQ(problems([](MechanicalThreshold& law) { law.shear_loss = 60e9; }).size(), 1u);
  EXPECT_EQ(
      problems([](MechanicalThreshold& law) { law.hardening_by_temperature = 10e6; }),
      testing::Problems{"hardening_modulus 2390000000 is not above hardening_by_temperature times initial_temperature: it would soften"});
}

}  // namespace
}  // namespace talus::mechanical_threshold_test
