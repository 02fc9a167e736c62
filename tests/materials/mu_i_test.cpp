// Granular flow against mu(I) itself, and against Drucker-Prager where the rate does not matter.
#include "materials/mu_i.hpp"

#include <gtest/gtest.h>

#include "materials/laboratory/point_path.hpp"
#include "tests/materials/soil.hpp"

namespace talus::mu_i_test {
namespace {

using testing::Dice;
using testing::Point;

constexpr Real root3 = std::numbers::sqrt3;

/// Glass beads of Jop, Forterre & Pouliquen 2006.
MuI beads(Real youngs_modulus = 1e7)
{
  MuI law;
  law.density = 1500;
  law.youngs_modulus = youngs_modulus;
  law.poisson_ratio = 0.3;
  law.static_friction = std::tan(testing::radians(20.9));
  law.limiting_friction = std::tan(testing::radians(32.76));
  law.inertial_number = 0.279;
  law.grain_diameter = 0.53e-3;
  law.grain_density = 2450;
  return law;
}
Real tau_of(const Mat3& stress) { return std::sqrt(second_invariant(stress)); }
Real pressure_of(const Mat3& stress) { return -stress.trace() / 3; }

TEST(MuI, SteadyShearUnderConstantPressureMobilisesTheFrictionOfItsInertialNumber)
{
  const MuI law = beads(1e9);
  constexpr Real p = 1e4, shear_of_step = 1e-5;
  constexpr Control pressed{Controlled::stress, -p};
  for (const Real inertial : {1e-4, 1e-2, 0.1, 0.279, 1.0, 10.0}) {
    const Real rate = inertial * std::sqrt(p / law.grain_density) / law.grain_diameter;
    const PointPath path{.steps = 60,
                         .time = 60 * shear_of_step / rate,
                         .controls = {.xx = pressed, .yy = pressed, .zz = pressed, .xy = Control{Controlled::velocity_gradient, rate}}};
    const auto end = drive(make_material(law, 0, 1, "beads"), {&path, 1}, -p * Mat3::Identity()).rows.back();
    const Real friction = law.static_friction + (law.limiting_friction - law.static_friction) / (1 + law.inertial_number / inertial);
    EXPECT_NEAR(end.stress(0, 1) / p, friction, 1e-8 * friction) << inertial;  // elastic strain squared 1e-10, shear of a step squared
    EXPECT_NEAR(end.p, p, 1e-9 * p);
  }
}

TEST(MuI, FrictionOfPublishedBeadsAtItsInertialNumberIsHalfWay)
{
  const MuI law = beads();
  EXPECT_NEAR(law.friction(0), std::tan(testing::radians(20.9)), 1e-15);
  EXPECT_NEAR(law.friction(0.279), (law.static_friction + law.limiting_friction) / 2, 1e-15);
  EXPECT_NEAR(law.friction(1e12), std::tan(testing::radians(32.76)), 1e-12);
}

TEST(MuI, EveryStepOfARandomPathEndsOnTheRateLaw)
{
  const MuI law = beads();
  const auto c = law.constants();
  Dice dice(1);
  int flowing = 0, open = 0, fast = 0;
  for (int path = 0; path < 2500; ++path) {
    Point<MuI> point{.law = law};
    for (int n = 0; n < 40; ++n) {
      const MuI::State before = point.state;
      const Real dt = std::pow(10, dice.real(-7, 0));
      point.step(Mat3::Identity() + dice.matrix(n % 10 == 9 ? 0.05 : 0.003) - dice.real(-0.001, 0.002) * Mat3::Identity(), false, dt);
      ASSERT_TRUE(point.stress.allFinite());
      ASSERT_GE(point.state.plastic_strain, before.plastic_strain);
      ASSERT_GE(point.state.plastic_work, before.plastic_work);
      const Real p = pressure_of(point.stress), tau = tau_of(point.stress);
      const Real rate = root3 * (point.state.plastic_strain - before.plastic_strain) / dt;
      const Real rounding = 1e-12 * c.shear;  // strains of up to 1 in tens of operations
      ASSERT_GE(p, -rounding);
      ASSERT_LE(tau, law.limiting_friction * p + rounding);
      if (point.state.opened_volume > 0) {
        ++open;
        ASSERT_LE(tau + std::abs(p), rounding);
      } else if (rate > 0) {
        ++flowing;
        const Real inertial = rate * law.grain_diameter * std::sqrt(law.grain_density / p);
        fast += inertial > law.inertial_number;
        ASSERT_NEAR(tau, law.friction(inertial) * p, rounding) << inertial;
      } else {
        ASSERT_LE(tau, law.static_friction * p + rounding);
      }
    }
  }
  EXPECT_GT(flowing, 20000);
  EXPECT_GT(open, 10000);
  EXPECT_GT(fast, 1000);
}

TEST(MuI, WithOneFrictionItIsDruckerPragerWithoutCohesionAndDilation)
{
  MuI law = beads();
  law.static_friction = law.limiting_friction = std::sin(testing::radians(30));
  auto cone = testing::soft_soil(ConeMatch::plane_strain, 30, 0);
  ASSERT_NEAR(cone.cone(0).q, law.static_friction, 1e-15);
  Dice dice(2);
  for (int path = 0; path < 100; ++path) {
    Point<MuI> flow{.law = law};
    Point<DruckerPrager> soil{.law = cone};
    for (int n = 0; n < 40; ++n) {
      const Mat3 f = Mat3::Identity() + dice.matrix(n % 10 == 9 ? 0.05 : 0.003);
      flow.step(f);
      soil.step(f);
      ASSERT_LE((flow.stress - soil.stress).norm(), 1e-12 * 1e7) << n;  // of Young's modulus
      ASSERT_NEAR(flow.state.plastic_strain, soil.state.plastic_strain, 1e-12);
      ASSERT_NEAR(flow.state.plastic_work, soil.state.plastic_work, 1e-12 * 1e7);
      ASSERT_NEAR(flow.state.opened_volume, soil.state.opened_volume, 1e-12);
    }
  }
}

TEST(MuI, SlowFlowTendsToStaticFrictionAndFastFlowToTheLimit)
{
  const MuI law = beads();
  const auto friction_after = [&](Real dt) {
    Point<MuI> point{.law = law};
    point.prestress(-1e4 * Mat3::Identity());
    Mat3 f = Mat3::Identity();
    f(0, 1) = 0.01;
    point.step(f, false, dt);
    return tau_of(point.stress) / pressure_of(point.stress);
  };
  EXPECT_NEAR(friction_after(1e8), law.static_friction, 1e-9);
  EXPECT_NEAR(friction_after(1e-12), law.limiting_friction, 1e-6);
  EXPECT_GT(friction_after(1e-3), friction_after(1e-2));
}

TEST(MuI, BelowStaticFrictionItIsElastic)
{
  Point<MuI> point{.law = beads()};
  Point<Hencky> solid{};
  solid.law.density = 1500;
  solid.law.youngs_modulus = 1e7;
  solid.law.poisson_ratio = 0.3;
  solid.constants = solid.law.constants();
  Mat3 f = 0.99 * Mat3::Identity();
  f(0, 1) = 0.005;
  point.step(f);
  solid.step(f);
  ASSERT_LT(tau_of(point.stress), point.law.static_friction * pressure_of(point.stress));
  EXPECT_LE((point.stress - solid.stress).norm(), 1e-13 * 1e7);
  EXPECT_EQ(point.state.plastic_strain, 0);
}

TEST(MuI, OpensFreelyAndClosesBeforeCompression)
{
  Point<MuI> point{.law = beads()};
  point.step(1.01 * Mat3::Identity());
  EXPECT_EQ(point.stress.norm(), 0);
  EXPECT_NEAR(point.state.opened_volume, 3 * std::log(1.01), 1e-14);
  point.step(1 / 1.005 * Mat3::Identity());
  EXPECT_EQ(point.stress.norm(), 0);
  point.step(1 / 1.01 * Mat3::Identity());
  EXPECT_EQ(point.state.opened_volume, 0);
  EXPECT_NEAR(pressure_of(point.stress) * point.F.determinant(), 1e7 / (3 * 0.4) * 3 * std::log(1.005), 1e-12 * 1e7);
  EXPECT_EQ(point.state.plastic_work, 0);
}

TEST(MuI, PlasticWorkIsShearStressTimesPlasticShear)
{
  const MuI law = beads(1e9);
  Point<MuI> point{.law = law};
  point.prestress(-1e4 * Mat3::Identity());
  Mat3 f = Mat3::Identity();
  f(0, 1) = 1e-6;
  Real work = 0;
  for (int n = 0; n < 200; ++n) {
    const Real before = point.state.plastic_strain;
    point.step(f, false, 1e-8);
    work += tau_of(point.stress) * root3 * (point.state.plastic_strain - before);
  }
  EXPECT_GT(work, 0);
  EXPECT_NEAR(point.state.plastic_work, work, 1e-4 * work);  // Kirchhoff against Cauchy: J is within 1e-5 of one
}

/// Of a start stress, which is Kirchhoff stress as well: J is one.
TEST(MuI, YieldIsShearStressLessTheLimitingFrictionOfThePressure)
{
  const MuI law = beads();
  Mat3 stress = Vec3(-3e3, -5e3, -1e4).asDiagonal();
  stress(0, 1) = stress(1, 0) = 700;
  MuI::State state;
  law.prestress(stress, state);
  const Real expected = tau_of(stress) - law.limiting_friction * pressure_of(stress);
  EXPECT_NEAR(law.yield(stress, state), expected, 1e-9 * pressure_of(stress));  // strains of 1e-3 keep 1e-13 of themselves
}

TEST(MuIRules, ContradictionsAreToldInWords)
{
  const auto problems = [](auto change) { return testing::problems_of(beads(), change); };
  using testing::Problems;
  EXPECT_EQ(problems([](auto&) {}), Problems{});
  EXPECT_EQ(problems([](auto& law) { law.static_friction = 0.5, law.limiting_friction = 0.4; }),
            Problems{"limiting_friction 0.4 is below static_friction 0.5"});
  EXPECT_EQ(problems([](auto& law) { law.density = 2500; }), Problems{"density 2500 of grains and voids is above grain_density 2450"});
  EXPECT_EQ(problems([](auto& law) { law.bulk_modulus = 1e7; }).size(), 1u) << "the elastic pair is checked as well";
}

}  // namespace
}  // namespace talus::mu_i_test
