// Fracture of Johnson & Cook's metal, and what is left of it.
#include <gtest/gtest.h>

#include "materials/laboratory/point_path.hpp"
#include "tests/materials/metals.hpp"

namespace talus::johnson_cook_failure_test {
namespace {

using testing::Dice;
using testing::Point;
using testing::stretch;

constexpr Real machine = 1e-12;  // relative: rounding of some hundred operations

/// Neither rate nor heat: the strain at fracture depends on the stress alone.
JohnsonCook slow_copper()
{
  JohnsonCook law = testing::copper();
  law.damage = testing::copper_damage;
  law.reference_rate = 1e12;
  law.heat_fraction = 0;
  return law;
}

TEST(JohnsonCookDamage, FractureStrainMatchesTheTableOfBothMetals)
{
  using testing::copper_damage, testing::steel_damage;
  EXPECT_NEAR(copper_damage.fracture_strain(0, 1, 0), 5.43, machine);
  EXPECT_NEAR(copper_damage.fracture_strain(1.0 / 3, 1, 0), 2.32103, 0.51e-5);
  EXPECT_NEAR(copper_damage.fracture_strain(1, 1, 0), 0.77626, 0.51e-5);
  EXPECT_NEAR(steel_damage.fracture_strain(0, 1, 0), 3.49, machine);
  EXPECT_NEAR(steel_damage.fracture_strain(1.0 / 3, 1, 0), 1.74690, 0.51e-5);
  EXPECT_NEAR(steel_damage.fracture_strain(1, 1, 0), 0.46291, 0.51e-5);
}

TEST(JohnsonCookDamage, RateAndHeatStretchTheFractureStrain)
{
  const JohnsonCookDamage& d = testing::copper_damage;
  EXPECT_NEAR(d.fracture_strain(0, std::exp(10.0), 0) / 5.43, 1.14, machine);
  EXPECT_EQ(d.fracture_strain(0, 1e-9, 0), d.fracture_strain(0, 1, 0));
  EXPECT_NEAR(d.fracture_strain(0, 1, 0.5) / 5.43, 1.56, machine);
}

TEST(JohnsonCookDamage, FractureStrainStaysAboveZeroAndFinite)
{
  const JohnsonCookDamage iron{.d1 = -2.2, .d2 = 5.43, .d3 = -0.47, .d4 = 0.016, .d5 = 0.63};  // Johnson & Cook 1985, Armco iron
  EXPECT_NEAR(iron.fracture_strain(0, 1, 0), 3.23, machine);
  EXPECT_EQ(iron.fracture_strain(3, 1, 0), 1e-6);
  const JohnsonCookDamage odd{.d1 = -1, .d2 = 0, .d3 = -1, .d4 = -1, .d5 = 0};
  EXPECT_EQ(odd.fracture_strain(0, 1e9, 0), 1e-6);  // two negative factors do not make a positive strain
  for (const Real triaxiality : {-1e300, 1e300, -1e3})
    EXPECT_TRUE(std::isfinite(testing::copper_damage.fracture_strain(triaxiality, 1, 0))) << triaxiality;
  EXPECT_NEAR(testing::copper_damage.fracture_strain(1e300, 1, 0), 0.54, machine);
}

TEST(JohnsonCookFailure, DamageIsPlasticStrainOverFractureStrain)
{
  Point<JohnsonCook> shear{.law = slow_copper()};
  for (int n = 0; n < 100; ++n)
    shear.step(stretch(0.01));
  // A stretch that keeps the volume keeps the mean stress at zero, up to the rounding of strain times bulk modulus.
  EXPECT_NEAR(shear.state.damage / (shear.state.plastic_strain / 5.43), 1, 1e-9);

  const Control none{Controlled::stress, 0};
  const PointPath pull{.steps = 100, .controls = {.xx = Control{Controlled::strain_rate, 0.5}, .yy = none, .zz = none}};
  const auto [names, rows] = drive(make_material(slow_copper(), 0, 1, "bar"), {&pull, 1});
  ASSERT_EQ(names[6], "plastic_strain [-]");
  ASSERT_EQ(names.back(), "damage [-]");
  EXPECT_NEAR(rows.back().history.back() / (rows.back().history[6] / testing::copper_damage.fracture_strain(1.0 / 3, 1, 0)), 1, 1e-9);
}

TEST(JohnsonCookFailure, ComesWhenDamageIsOneAndTakesShearAndTension)
{
  Point<JohnsonCook> point{.law = slow_copper()};
  const Real K = *point.law.bulk_modulus, G = *point.law.shear_modulus;
  while (point.state.damage < 1) {
    ASSERT_LT(point.state.plastic_strain, 5.5);
    point.step(stretch(0.01));
  }
  EXPECT_EQ(point.state.damage, 1);
  EXPECT_NEAR(point.state.plastic_strain, 5.43, 0.01);  // a step
  EXPECT_LE(von_mises(point.stress), machine * G);
  const Real p = point.state.plastic_strain, work = point.state.plastic_work;

  Dice dice(1);
  Real volume = point.F.determinant();
  for (int n = 0; n < 200; ++n) {
    point.step(Mat3::Identity() + dice.matrix(0.03));
    volume = point.F.determinant();
    ASSERT_LE(von_mises(point.stress), machine * G);
    ASSERT_NEAR(-point.stress.trace() / 3, std::max(-K * std::log(volume) / volume, 0.0), 1e-11 * K);  // rounding of 500 steps
  }
  point.step(std::cbrt(0.9 / volume) * Mat3::Identity());
  EXPECT_NEAR(-point.stress.trace() / 3 / (-K * std::log(0.9) / 0.9), 1, 1e-9);
  EXPECT_EQ(point.state.damage, 1);
  EXPECT_EQ(point.state.plastic_strain, p);
  EXPECT_EQ(point.state.plastic_work, work);
  EXPECT_LE(point.law.yield(point.stress, point.state), machine * G);
}

TEST(JohnsonCookFailure, DissipatesTheElasticEnergyItSetsFree)
{
  // Tension across and shear: what the twin that does not fail keeps as elastic energy is lost.
  const Mat3 f = Vec3(1.01, 1, 1).asDiagonal();
  Point<JohnsonCook> breaking{.law = slow_copper()};
  breaking.law.damage = JohnsonCookDamage{.d1 = 1e-5, .d2 = 0, .d3 = 0, .d4 = 0, .d5 = 0};
  Point<JohnsonCook> whole{.law = slow_copper()};
  whole.law.damage.reset();
  breaking.step(f);
  whole.step(f);
  const Real K = *whole.law.bulk_modulus, G = *whole.law.shear_modulus, J = 1.01;
  const Mat3 t = J * whole.stress;
  const Real elastic = std::pow(t.trace() / 3, 2) / (2 * K) + dev(t).squaredNorm() / (4 * G);
  EXPECT_EQ(breaking.stress.norm(), 0);
  EXPECT_NEAR((breaking.state.plastic_work - whole.state.plastic_work) / elastic, 1, machine);
  EXPECT_EQ(breaking.state.temperature, whole.state.temperature);
}

TEST(JohnsonCookFailure, KeepsPressureInCompression)
{
  JohnsonCook law = slow_copper();
  law.damage = JohnsonCookDamage{.d1 = 1e-5, .d2 = 0, .d3 = 0, .d4 = 0, .d5 = 0};
  law.mie_gruneisen = testing::copper_shock;
  JohnsonCook tough = law;
  tough.damage.reset();
  Point<JohnsonCook> breaking{.law = law}, whole{.law = tough};
  const Mat3 f = Vec3(0.98, 1, 1).asDiagonal();
  breaking.step(f);
  whole.step(f);
  ASSERT_EQ(breaking.state.damage, 1);
  EXPECT_GT(von_mises(whole.stress), 1e8);
  EXPECT_LE((breaking.stress - whole.stress.trace() / 3 * Mat3::Identity()).norm(), machine * whole.stress.norm());
  EXPECT_EQ(breaking.state.internal_energy, whole.state.internal_energy);  // work of the stress is work of the stress
  breaking.step(Vec3(1.1, 1, 1).asDiagonal());
  EXPECT_EQ(breaking.stress.norm(), 0);
}

TEST(JohnsonCookFailure, NeedsPlasticFlow)
{
  Point<JohnsonCook> point{.law = slow_copper()};
  point.state.damage = 0.999999;
  point.step(Vec3(1.0005, 1, 1).asDiagonal());
  EXPECT_EQ(point.state.plastic_strain, 0);
  point.step(stretch(0.5), true);
  EXPECT_EQ(point.state.damage, 0.999999);
  EXPECT_GT(von_mises(point.stress), 1e10);
}

TEST(JohnsonCookDamageRules, ConstantsThatCannotBeMeantAreToldInWords)
{
  const auto problems = [](const JohnsonCookDamage& damage) {
    std::vector<std::string> found;
    damage.check(found);
    return found;
  };
  using Problems = std::vector<std::string>;
  EXPECT_EQ(problems(testing::copper_damage), Problems{});
  EXPECT_EQ(problems({.d1 = -2.2, .d2 = 5.43, .d3 = -0.47, .d4 = 0.016, .d5 = 0.63}), Problems{});
  EXPECT_EQ(problems({.d1 = 0, .d2 = 0, .d3 = -3, .d4 = 0, .d5 = 0}),
            Problems{"d1 0 and d2 0 leave no plastic strain before fracture: it fails at once"});
  EXPECT_EQ(problems({.d1 = -3, .d2 = 2, .d3 = 0, .d4 = 0, .d5 = 0}),
            Problems{"d1 -3 and d2 2 leave no plastic strain before fracture: it fails at once"});
  EXPECT_EQ(problems({.d1 = 0.54, .d2 = 4.89, .d3 = 3.03, .d4 = 0, .d5 = 0}),
            Problems{"d3 3.03 is above 0: tension would make the metal tougher; mean stress is positive in tension here"});
  EXPECT_EQ(problems({.d1 = 0.54, .d2 = 4.89, .d3 = -3.03, .d4 = 0, .d5 = -1}),
            Problems{"d5 -1 is not above -1: at some temperature below melting it fails at once"});
}

}  // namespace
}  // namespace talus::johnson_cook_failure_test
