// Porous metal: limits and closed forms of the surface, growth, nucleation and closing of voids, failure.
#include "materials/porous_ductile.hpp"

#include <gtest/gtest.h>

#include "tests/materials/metals.hpp"

namespace talus::porous_ductile_test {
namespace {

using testing::Dice;
using testing::Point;
using testing::random_step;
using testing::stretch;

/// A steel with the constants of Tvergaard & Needleman 1984 for voids, and none that open.
PorousDuctile steel(Real porosity)
{
  PorousDuctile law;
  law.density = 7800;
  law.youngs_modulus = 200e9;
  law.poisson_ratio = 0.3;
  law.yield_stress = 400e6;
  law.initial_porosity = porosity;
  return law;
}
PorousDuctile hardening_steel(Real porosity)
{
  PorousDuctile law = steel(porosity);
  law.hardening_coefficient = 500e6;
  law.hardening_exponent = 0.4;
  return law;
}
PorousDuctile steel_of_all()
{
  PorousDuctile law = hardening_steel(0.002);
  law.nucleation = VoidNucleation{.porosity = 0.04, .mean_strain = 0.3, .deviation = 0.1};
  law.coalescence = VoidCoalescence{.porosity = 0.15, .failure_porosity = 0.25};
  return law;
}

Mat3 swell(Real log_volume) { return std::exp(log_volume / 3) * Mat3::Identity(); }
Real porosity(const Point<PorousDuctile>& at) { return at.law.initial_porosity + at.state.porosity_gain; }
Real mean_stress(const Point<PorousDuctile>& at) { return at.stress.trace() / 3; }
/// The plastic volume strain: of what is deformed and what is elastic.
Real plastic_volume(const Point<PorousDuctile>& at)
{
  const Real J = at.F.determinant();
  return std::log(J) - J * mean_stress(at) / at.constants.bulk;
}
Real effective(const PorousDuctile& law, Real f)
{
  const Real ultimate = 1 / law.q1, begin = law.coalescence ? law.coalescence->porosity : ultimate;
  const Real end = law.coalescence ? law.coalescence->failure_porosity : 2 * ultimate;
  return f <= begin ? f : begin + (ultimate - begin) * (f - begin) / (end - begin);
}
/// Mean stress at which voids grow without shear.
Real hydrostatic_limit(const PorousDuctile& law, Real f, Real s)
{
  const Real v = effective(law, f);
  return 2 * s / (3 * law.q2) * std::acosh((1 + law.q1 * law.q1 * v * v) / (2 * law.q1 * v));
}

TEST(PorousDuctile, WithoutVoidsItIsVonMises)
{
  VonMises other;
  other.density = 7800;
  other.youngs_modulus = 200e9;
  other.poisson_ratio = 0.3;
  other.yield_stress = 400e6;
  other.power = PowerHardening{.coefficient = 500e6, .exponent = 0.4};
  Dice dice(1);
  for (int path = 0; path < 30; ++path) {
    Point<PorousDuctile> a{.law = hardening_steel(0)};
    Point<VonMises> b{.law = other};
    for (int n = 0; n < 40; ++n) {
      const Mat3 f = random_step(dice);
      a.step(f);
      b.step(f);
      ASSERT_LE((a.stress - b.stress).norm(), 1e-10 * b.stress.norm()) << path << " " << n;
      ASSERT_NEAR(a.state.plastic_strain, b.state.plastic_strain, 1e-11 * (1 + b.state.plastic_strain));
      ASSERT_NEAR(a.state.matrix_strain, b.state.plastic_strain, 1e-11 * (1 + b.state.plastic_strain));
      ASSERT_EQ(a.state.porosity_gain, 0);
    }
    EXPECT_GT(a.state.plastic_strain, 0.02);
  }
}

TEST(PorousDuctile, ExpandsAtTheHydrostaticLimitAndKeepsTheMassOfTheMatrix)
{
  for (const bool joins : {false, true})
    for (const Real f0 : {0.002, 0.05})
      for (const Real step : {1e-4, 1e-2}) {
        PorousDuctile law = steel(f0);
        if (joins)
          law.coalescence = VoidCoalescence{.porosity = 0.15, .failure_porosity = 0.25};
        Point<PorousDuctile> point{.law = law};
        int flowing = 0;
        while (porosity(point) < 0.2) {
          point.step(swell(step));
          if (point.state.porosity_gain == 0)
            continue;
          ++flowing;
          const Real f = porosity(point), p = mean_stress(point);
          ASSERT_NEAR(p, hydrostatic_limit(law, f, law.yield_stress), 1e-9 * law.yield_stress) << f;
          ASSERT_LE(von_mises(point.stress), 1e-9 * law.yield_stress);
          ASSERT_NEAR(1 - f, (1 - f0) * std::exp(-plastic_volume(point)), 1e-12) << "the matrix keeps its volume";
        }
        EXPECT_GT(flowing, 5);
      }
}

TEST(PorousDuctile, RandomStepsSatisfyTheirEquations)
{
  // From rest, in one step: the flow is normal to the surface at the end, and the matrix takes up the work of the stress.
  Dice dice(2);
  int grown = 0, shrunk = 0, closed = 0, sheared = 0;
  for (int n = 0; n < 20000; ++n) {
    const PorousDuctile law = hardening_steel(n % 5 ? std::pow(10.0, dice.real(-4, -0.7)) : 0);
    Point<PorousDuctile> point{.law = law};
    point.step(random_step(dice) * swell(dice.real(-0.02, 0.02)));
    ASSERT_TRUE(point.stress.allFinite());
    const auto& s = point.state;
    ASSERT_GE(s.plastic_work, 0);
    const Real p = mean_stress(point), q = von_mises(point.stress), f = porosity(point), volume = plastic_volume(point);
    ASSERT_LE(law.yield(point.stress, s), 1e-9 * law.yield_stress) << n;
    if (s.matrix_strain == 0)
      continue;
    ASSERT_NEAR(1 - f, (1 - law.initial_porosity) * std::exp(-volume), 1e-11) << n;
    if (f == 0) {
      law.initial_porosity > 0 ? ++closed : ++sheared;
      ASSERT_LE(q, law.flow_stress(s.matrix_strain) * (1 + 1e-9));
      if (law.initial_porosity == 0) {
        ASSERT_GE(q, law.flow_stress(s.matrix_strain) * (1 - 1e-9));
      }
      continue;
    }
    const Real held = p > 0 ? f : law.initial_porosity;  // voids that close do so at the porosity before
    const Real matrix = law.flow_stress(s.matrix_strain), h = 1.5 * p / matrix;
    ASSERT_NEAR((1 - held) * matrix * s.matrix_strain, p * volume + q * s.plastic_strain, 1e-9 * matrix * s.matrix_strain + 1)
        << n << " " << p << " " << q << " " << f << " " << law.initial_porosity << " " << volume << " " << s.plastic_strain << " "
        << s.matrix_strain << " " << matrix;
    ASSERT_NEAR(s.plastic_work, point.F.determinant() * (p * volume + q * s.plastic_strain), 1e-9 * s.plastic_work + 1) << n;
    const Real along_p = 3 * law.q1 * held * std::sinh(h) / matrix, along_q = 2 * q / (matrix * matrix);
    const Real size = std::hypot(volume, s.plastic_strain) * std::hypot(along_p, along_q);
    ASSERT_NEAR(volume * along_q, s.plastic_strain * along_p, 1e-8 * size) << n;
    ASSERT_NEAR(q * q / (matrix * matrix) + 2 * law.q1 * held * std::cosh(h) - 1 - law.q1 * law.q1 * held * held, 0, 1e-9) << n;
    p > 0 ? ++grown : ++shrunk;
  }
  EXPECT_GT(grown, 3000);
  EXPECT_GT(shrunk, 2000);
  EXPECT_GT(closed, 300);
  EXPECT_GT(sheared, 1000);
}

TEST(PorousDuctile, RandomPathsNeverGainWorkAndEndInsideTheSurface)
{
  Dice dice(3);
  int failed = 0;
  for (int path = 0; path < 300; ++path) {
    Point<PorousDuctile> point{.law = steel_of_all()};
    for (int n = 0; n < 60; ++n) {
      const auto before = point.state;
      point.step(random_step(dice));
      ASSERT_TRUE(point.stress.allFinite()) << path << " " << n;
      ASSERT_GE(point.state.plastic_work, before.plastic_work);
      ASSERT_GE(point.state.plastic_strain, before.plastic_strain);
      ASSERT_GE(porosity(point), -1e-17);
      ASSERT_LE(point.law.yield(point.stress, point.state), 1e-8 * point.law.yield_stress) << path << " " << n;
    }
    failed += porosity(point) >= 0.25;
  }
  EXPECT_GT(failed, 20);
  EXPECT_LT(failed, 300);
}

TEST(PorousDuctile, VoidsOpenWithTheStrainOfTheMatrix)
{
  PorousDuctile law = steel(0);
  law.q2 = 1e-9;  // voids do not grow
  law.nucleation = VoidNucleation{.porosity = 0.04, .mean_strain = 0.3, .deviation = 0.1};
  const auto opened = [&](Real strain, int steps) {
    Point<PorousDuctile> point{.law = law};
    point.prestress(1e6 * Mat3::Identity());  // tension
    for (int n = 0; n < steps; ++n)
      point.step(stretch(strain / steps));
    const auto share = [&](Real e) { return 0.5 * std::erf((e - 0.3) / (0.1 * std::sqrt(2.0))); };
    return porosity(point) / (0.04 * (share(point.state.matrix_strain) - share(0))) - 1;
  };
  for (const Real strain : {0.2, 0.4, 1.0})
    EXPECT_NEAR(opened(strain, 2000), 0, 1e-5) << strain;
  EXPECT_NEAR(opened(0.25, 20) / opened(0.25, 40), 4, 0.2) << "of second order";
}

TEST(PorousDuctile, ClosesUnderPressureAndHardensNoMoreByIt)
{
  for (const int steps : {1, 10, 1000}) {
    Point<PorousDuctile> point{.law = hardening_steel(0.01)};
    for (int n = 0; n < steps; ++n)
      point.step(swell(-0.12 / steps));
    EXPECT_NEAR(porosity(point), 0, 1e-15);
    const Real J = point.F.determinant(), volume = std::log1p(-0.01);
    EXPECT_NEAR(mean_stress(point), point.constants.bulk * (std::log(J) - volume) / J, 1e-9 * point.constants.bulk);
    EXPECT_LE(von_mises(point.stress), 1e-4);
    const Real work = point.state.plastic_work;
    point.step(swell(-0.01));
    EXPECT_EQ(point.state.plastic_work, work);
    point.step(stretch(0.1));
    EXPECT_NEAR(von_mises(point.stress), point.law.flow_stress(point.state.matrix_strain), 1e-10 * von_mises(point.stress));
  }
}

TEST(PorousDuctile, TearsWhereVoidsHaveJoined)
{
  PorousDuctile law = steel(0.05);
  law.coalescence = VoidCoalescence{.porosity = 0.1, .failure_porosity = 0.2};
  Point<PorousDuctile> point{.law = law};
  Real before = HUGE_VAL;
  int steps = 0;
  for (; porosity(point) < 0.2 && steps < 10000; ++steps) {
    point.step(swell(1e-3));
    if (porosity(point) > 0.06 && porosity(point) < 0.2) {
      ASSERT_LT(mean_stress(point), before);
      before = mean_stress(point);
    }
  }
  EXPECT_LT(before, 0.1 * hydrostatic_limit(law, 0.1, law.yield_stress)) << "little was left before it tore";
  EXPECT_EQ(point.stress.norm(), 0);
  const Real work = point.state.plastic_work;
  point.step(swell(0.1) * stretch(0.2));
  EXPECT_EQ(point.stress.norm(), 0);
  EXPECT_EQ(point.state.plastic_work, work);
  while (std::log(point.F.determinant()) > 0.2)
    point.step(swell(-0.02));
  EXPECT_EQ(point.stress.norm(), 0) << "the gap has to close";
  while (std::log(point.F.determinant()) > -0.1)
    point.step(swell(-0.02));
  EXPECT_LT(mean_stress(point), -1e9);
  EXPECT_LE(von_mises(point.stress), 1e-6);
}

TEST(PorousDuctile, AUniaxialTestTearsEarlierWithMoreVoids)
{
  Real last = HUGE_VAL;
  for (const Real f0 : {0.001, 0.01, 0.05}) {
    PorousDuctile law = hardening_steel(f0);
    law.coalescence = VoidCoalescence{.porosity = 0.1, .failure_porosity = 0.2};
    Point<PorousDuctile> point{.law = law};
    int n = 0;
    for (; porosity(point) < 0.2 && n < 100000; ++n)  // with a mean stress of the size of the strength, as in a notch
      point.step(stretch(1e-4) * swell(mean_stress(point) < 1.2 * std::max(von_mises(point.stress), 1e8) ? 2e-4 : 0));
    EXPECT_EQ(point.stress.norm(), 0);
    EXPECT_LT(point.state.plastic_strain, 0.8 * last);
    last = point.state.plastic_strain;
  }
}

TEST(PorousDuctile, ContradictionsAreRefused)
{
  const auto problems = [](auto&& change) { return testing::problems_of(steel_of_all(), change); };
  EXPECT_TRUE(problems([](PorousDuctile&) {}).empty());
  EXPECT_EQ(problems([](PorousDuctile& law) { law.q3 = 3; }),
            testing::Problems{"q3 3 is above the square of q1: the surface would not shrink to a point"});
  EXPECT_EQ(problems([](PorousDuctile& law) { law.coalescence->failure_porosity = 0.1; }),
            testing::Problems{"failure_porosity 0.1 is not above the porosity 0.15 at which voids join"});
  EXPECT_EQ(problems([](PorousDuctile& law) { law.coalescence = VoidCoalescence{.porosity = 0.7, .failure_porosity = 0.8}; }),
            testing::Problems{"voids join at porosity 0.7, where by q1 nothing is left: that is 0.666667"});
  EXPECT_EQ(problems([](PorousDuctile& law) { law.initial_porosity = 0.3; }),
            testing::Problems{"initial_porosity 0.3 is not below that of failure, 0.25"});
}

}  // namespace
}  // namespace talus::porous_ductile_test
