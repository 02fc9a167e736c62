// The Mie-Grueneisen curve alone, and in the law that uses it.
#include "materials/parts/equation_of_state.hpp"

#include <gtest/gtest.h>

#include "materials/laboratory/point_path.hpp"
#include "tests/materials/metals.hpp"

namespace talus::equation_of_state_test {
namespace {

using testing::Dice;
using testing::Point;
using testing::stretch;

constexpr Real machine = 1e-12;  // relative: rounding of some hundred operations

/// States behind shocks with the particle speeds 50, 100, 500, 1000 m/s.
struct Shocks {
  Real density;
  MieGruneisen solid;
  JohnsonCook law;
  std::array<Real, 4> pressure;  ///< GPa
  std::array<Real, 4> densification;
};
constexpr std::array<Real, 4> particle_speeds{50, 100, 500, 1000};
std::vector<Shocks> shocks()
{
  std::vector<Shocks> both{
      {8930, testing::copper_shock, testing::copper(), {1.7925, 3.6514, 20.9163, 48.4810}, {1.01261, 1.02507, 1.11949, 1.22578}},
      {7830, testing::steel_shock, testing::steel(), {1.4368, 2.9488, 17.7506, 43.0180}, {1.01381, 1.02728, 1.12395, 1.22252}}};
  for (Shocks& s : both)
    s.law.density = s.density, s.law.mie_gruneisen = s.solid;
  return both;
}

TEST(MieGruneisen, ReturnsTheHugoniotThatItIsMadeFrom)
{
  for (const Shocks& metal : shocks()) {
    const MieGruneisenCurve curve(metal.solid, metal.density);
    for (std::size_t k = 0; k < 4; ++k) {
      const Real up = particle_speeds[k], us = metal.solid.c0 + metal.solid.s * up;
      const Real pressure = curve.cold_pressure(up / us) + metal.solid.gamma * metal.density * up * up / 2;
      EXPECT_NEAR(pressure / (metal.density * us * up), 1, machine);
      EXPECT_NEAR(pressure / 1e9, metal.pressure[k], 0.51e-4);  // half of the last digit
      EXPECT_NEAR(us / (us - up), metal.densification[k], 0.51e-5);
    }
  }
}

TEST(MieGruneisen, CompressionOfAPressureInvertsTheCurve)
{
  const MieGruneisenCurve curve(testing::copper_shock, 8930);
  for (const Real e : {-1e6, -3.0, -0.1, -1e-9, 0.0, 1e-12, 1e-3, 0.1, 0.4, 0.6})
    EXPECT_NEAR(curve.compression_at(curve.cold_pressure(e)), e, 1e-10 * std::abs(e) * (1 + std::abs(e))) << e;
  EXPECT_TRUE(std::isnan(curve.compression_at(-curve.bulk)));
}

TEST(MieGruneisen, GoesStraightOnBeforeThePole)
{
  for (const MieGruneisen& solid : {testing::copper_shock, testing::steel_shock, MieGruneisen{.c0 = 1500, .s = 0, .gamma = 0.3}}) {
    const MieGruneisenCurve curve(solid, 5000);
    Real below = -curve.bulk;
    for (Real e = -1; e <= 1; e += 1e-3) {
      const Real pressure = curve.cold_pressure(e);
      ASSERT_GT(pressure, below) << e;
      below = pressure;
    }
    ASSERT_TRUE(std::isfinite(curve.stiffness(1)));
  }
  const MieGruneisenCurve curve(testing::copper_shock, 8930);
  const Real edge = 0.9 / 1.489, h = 1e-7;
  EXPECT_NEAR(curve.cold_pressure(edge * (1 + 1e-15)) / curve.cold_pressure(edge), 1, machine);
  const auto slope = [&](Real e) { return (curve.cold_pressure(e + h) - curve.cold_pressure(e - h)) / (2 * h); };
  EXPECT_NEAR(slope(edge + 2 * h) / slope(edge - 2 * h), 1, 1e-4);  // curvature times h
}

TEST(MieGruneisen, AStepFromRestLandsOnTheHugoniot)
{
  // The trapezoidal rule of the energy is the jump condition of Rankine and Hugoniot.
  for (const Shocks& metal : shocks())
    for (std::size_t k = 0; k < 4; ++k) {
      const Real up = particle_speeds[k], us = metal.solid.c0 + metal.solid.s * up;
      Point<JohnsonCook> point{.law = metal.law};
      point.step(std::cbrt(1 - up / us) * Mat3::Identity());
      EXPECT_NEAR(-point.stress.trace() / 3 / (metal.density * us * up), 1, 1e-11);  // rounding of the strain by its size
      EXPECT_NEAR(point.state.internal_energy / (metal.density * up * up / 2), 1, 1e-11);
      EXPECT_LE(von_mises(point.stress), machine * *metal.law.shear_modulus);
    }
}

TEST(MieGruneisen, InternalEnergyIsTheWorkOfTheStress)
{
  JohnsonCook law = testing::steel();
  law.mie_gruneisen = testing::steel_shock;
  const auto along = [](Real t) {  // loads, turns, shears, unloads into tension
    Mat3 F = testing::rotation_about(Vec3(1, 2, 3), t) * Mat3(Vec3(1 - 0.1 * std::sin(4 * t), 1 + 0.03 * t, 1).asDiagonal());
    F(0, 1) += 0.1 * t;
    return F;
  };
  const auto difference = [&](int steps) {
    Point<JohnsonCook> point{.law = law};
    Real work = 0;
    for (int n = 1; n <= steps; ++n) {
      const Mat3 F = along(static_cast<Real>(n) / steps), before = point.F.determinant() * point.stress, old = point.F;
      point.step(F * old.inverse());
      work += 0.5 * (before + point.F.determinant() * point.stress).cwiseProduct((F - old) * (0.5 * (F + old)).inverse()).sum();
    }
    EXPECT_GT(point.state.plastic_strain, 0.1);
    return point.state.internal_energy / work - 1;
  };
  EXPECT_NEAR(difference(4000), 0, 1e-6);
  EXPECT_NEAR(difference(500) / difference(1000), 4, 0.5);
}

TEST(MieGruneisen, SlowElasticCyclesGiveTheirEnergyBack)
{
  JohnsonCook law = testing::copper();
  law.mie_gruneisen = testing::copper_shock;
  Point<JohnsonCook> point{.law = law};
  Real most = 0;
  for (const Real rate : {-1.0, 1.0, 1.0, -1.0})
    for (int n = 0; n < 1000; ++n) {
      point.step(std::exp(rate * 5e-5) * Mat3::Identity());
      most = std::max(most, point.state.internal_energy);
    }
  EXPECT_NEAR(point.state.internal_energy, 0, 1e-6 * most);  // of second order in the step
  EXPECT_NEAR(point.stress.norm() / *law.bulk_modulus, 0, 1e-7);
  EXPECT_GT(most, 1e9);
}

TEST(MieGruneisen, ArtificialViscosityHeatsWhatItCompresses)
{
  JohnsonCook law = testing::copper();
  law.mie_gruneisen = testing::copper_shock;
  law.mie_gruneisen->gamma = 0;
  Point<JohnsonCook> quiet{.law = law}, viscous{.law = law};
  const Mat3 f = 0.999 * Mat3::Identity(), L = (f - Mat3::Identity()) / 1e-6;
  quiet.step(f, false, 1e-6);
  const Mat3 stress = law.update(Increment{f, L, viscous.stress, 1e-6, 3e8, false}, viscous.state, viscous.constants);
  EXPECT_EQ((stress - quiet.stress).norm(), 0);
  const Real work = 3e8 * (1 - f.determinant());
  EXPECT_NEAR(viscous.state.internal_energy - quiet.state.internal_energy, work, machine * quiet.state.internal_energy);
  law.mie_gruneisen->gamma = 2;
  Point<JohnsonCook> cold{.law = law}, hot{.law = law};
  cold.step(f, false, 1e-6);
  const Mat3 heated = law.update(Increment{f, L, hot.stress, 1e-6, 3e8, false}, hot.state, hot.constants);
  EXPECT_NEAR((cold.stress - heated).trace() / 3 / (2 * work), 1, 0.01);  // gamma E, and a little more work by it
}

TEST(MieGruneisen, WaveSpeedBoundsThatBehindShocks)
{
  for (const Shocks& metal : shocks())
    for (const Real up : {1.0, 50.0, 500.0, 1000.0, 2000.0}) {
      const Real us = metal.solid.c0 + metal.solid.s * up;
      Point<JohnsonCook> point{.law = metal.law};
      point.step(Vec3(1 - up / us, 1, 1).asDiagonal());
      const auto traction = [&](Real size) {
        Point<JohnsonCook> moved = point;
        moved.step(Vec3(1 + size, 1, 1).asDiagonal(), true);
        return moved.stress(0, 0);
      };
      constexpr Real h = 1e-5;
      const Real measured = std::sqrt((traction(h) - traction(-h)) / (2 * h) / (metal.density / point.F.determinant()));
      EXPECT_LE(measured, point.law.wave_speed(point.F, point.constants)) << up;
      EXPECT_GE(measured, 0.8 * point.law.wave_speed(point.F, point.constants)) << up;
    }
}

TEST(MieGruneisen, ElasticLimitOfAShockIsThatOfUniaxialStrain)
{
  JohnsonCook law = testing::stiffened(testing::steel());  // small strain
  law.bulk_modulus.reset();
  law.poisson_ratio = 0.3;
  const Real limit = 792e6 * 0.7 / 0.4, strain = limit / law.moduli().confined();
  EXPECT_NEAR(limit / 1e9, 1.386, 1e-12);
  for (const Real share : {1 - 1e-6, 1 + 1e-6}) {
    Point<JohnsonCook> point{.law = law};
    Mat3 H = Mat3::Zero();
    H(0, 0) = -share * strain;
    point.strain(H);
    EXPECT_EQ(point.state.plastic_strain > 0, share > 1);
    EXPECT_NEAR(point.stress(0, 0) / -limit, 1, 2e-6);
  }
}

}  // namespace
}  // namespace talus::equation_of_state_test
