// The lines, the ellipse and the critical state of Cam clay against closed forms.
#include "materials/modified_cam_clay.hpp"

#include <gtest/gtest.h>

#include "materials/laboratory/point_path.hpp"
#include "tests/materials/samples.hpp"

namespace talus::modified_cam_clay_test {
namespace {

using testing::Dice;
using testing::Point;

constexpr Real machine = 1e-10;  // relative: what the closed forms claim
constexpr Real p0 = 1e5;

/// A soft clay with M = 1, first yield at 100 kPa and OCR 1 there.
ModifiedCamClay clay()
{
  ModifiedCamClay law;
  law.density = 1800;
  law.shear_modulus = 3e6;
  law.compression_index = 0.1;
  law.swelling_index = 0.02;
  law.critical_state_slope = 1;
  law.preconsolidation_pressure = p0;
  law.reference_pressure = 1e4;
  return law;
}
/// The same with strains a thousand million times smaller: Kirchhoff and Cauchy stress are equal to 1e-9.
constexpr Real stiffening = 1e9;
ModifiedCamClay stiff_clay()
{
  ModifiedCamClay law = clay();
  law.shear_modulus *= stiffening;
  law.compression_index /= stiffening;
  law.swelling_index /= stiffening;
  return law;
}

Real pressure(const Mat3& stress) { return -stress.trace() / 3; }
/// Of the Kirchhoff stress, in which the law is written.
Real kirchhoff_pressure(const Point<ModifiedCamClay>& at) { return at.F.determinant() * pressure(at.stress); }
Real preconsolidation(const Point<ModifiedCamClay>& at) { return at.constants.preconsolidation_at(at.state.plastic_volume); }
Mat3 swell(Real log_volume) { return std::exp(log_volume / 3) * Mat3::Identity(); }
/// Axial (zz) logarithmic strain at constant volume.
Mat3 squeeze(Real axial) { return Vec3(-axial / 2, -axial / 2, axial).array().exp().matrix().asDiagonal(); }

Point<ModifiedCamClay> consolidated(const ModifiedCamClay& law, Real p)
{
  Point<ModifiedCamClay> point{.law = law};
  point.prestress(-p * Mat3::Identity());
  return point;
}

TEST(ModifiedCamClay, IsotropicCompressionAndSwellingFollowTheirLines)
{
  for (const int steps : {1, 10, 300}) {
    Point<ModifiedCamClay> point{.law = clay()};
    const auto go = [&](Real log_volume) {
      for (int n = 0; n < steps; ++n)
        point.step(swell(log_volume / steps));
      return kirchhoff_pressure(point);
    };
    const Real p = go(-0.3), volume = std::log(point.F.determinant());
    EXPECT_GT(p, 5 * p0);
    EXPECT_NEAR(preconsolidation(point), p, machine * p);
    EXPECT_NEAR(-volume, 0.02 * std::log(1 + p / 1e4) + 0.08 * std::log(p / p0), machine);
    EXPECT_NEAR(point.state.plastic_volume, -0.08 * std::log(p / p0), machine);
    const Real swollen = go(0.03);
    EXPECT_NEAR(std::log((p + 1e4) / (swollen + 1e4)), 0.03 / 0.02, machine / 0.02);
    EXPECT_NEAR(preconsolidation(point), p, machine * p) << "unloading is elastic";
    EXPECT_NEAR(go(-0.03), p, machine * p);
  }
}

TEST(ModifiedCamClay, SlopesAreTheIndicesWhereTheReferencePressureIsSmall)
{
  ModifiedCamClay law = clay();
  law.reference_pressure = 1e-4;  // 1e-9 of the pressures
  auto point = consolidated(law, p0);
  point.step(swell(-0.05));
  const Real p = kirchhoff_pressure(point);
  EXPECT_NEAR(0.05 / std::log(p / p0), law.compression_index, 2e-9 * law.compression_index);
  point.step(swell(0.01));
  EXPECT_NEAR(0.01 / std::log(p / kirchhoff_pressure(point)), law.swelling_index, 2e-9 * law.swelling_index);
}

TEST(ModifiedCamClay, PlasticWorkOfIsotropicCompressionIsTheIntegralOfPressure)
{
  constexpr int steps = 20000;
  auto point = consolidated(clay(), p0);
  for (int n = 0; n < steps; ++n)
    point.step(swell(-0.1 / steps));
  // Integral of p d(0.08 ln p); backward Euler is above by half of the last step: 1/40000 of the rise of the pressure.
  const Real work = 0.08 * (kirchhoff_pressure(point) - p0);
  EXPECT_NEAR(point.state.plastic_work, work, 1e-4 * work);
}

TEST(ModifiedCamClay, UndrainedShearEndsAtTheCriticalState)
{
  // Constant volume: kappa ln((p + p_ref)/(p0 + p_ref)) + (lambda - kappa) ln(pc/pc0) = 0, and q = M p, pc = 2 p at the end.  Where
  // p_ref is small q = M p0 (R/2)^(1 - kappa/lambda), R = pc0/p0: Wood 1990, Soil Behaviour and Critical State Soil Mechanics, 7.2.
  for (const Real overconsolidation : {1.0, 1.5, 3.0, 10.0})
    for (const Real reference : {1.0, 1e4})
      for (const Real direction : {-1.0, 1.0}) {
        ModifiedCamClay law = clay();
        law.reference_pressure = reference;
        const Real start = p0 / overconsolidation;
        auto point = consolidated(law, start);
        for (int n = 0; n < 3000; ++n)
          point.step(squeeze(direction * 1e-3));
        const Real p = pressure(point.stress), q = von_mises(point.stress);
        EXPECT_NEAR(q, p, 1e-6 * p);
        EXPECT_NEAR(preconsolidation(point), 2 * p, 1e-6 * p);
        EXPECT_NEAR(0.02 * std::log((p + reference) / (start + reference)) + 0.08 * std::log(2 * p / p0), 0, 1e-9);
        if (reference == 1) {
          EXPECT_NEAR(q / (start * std::pow(overconsolidation / 2, 0.8)), 1, reference / start + 1e-6);
        }
      }
}

TEST(ModifiedCamClay, UndrainedStrengthOfManyStepsIsThatOfFew)
{
  // The path is one of constant volume whatever the steps, so backward Euler ends on the same line: only how far shear has come differs.
  for (const Real overconsolidation : {1.0, 8.0}) {
    auto coarse = consolidated(clay(), p0 / overconsolidation), fine = coarse;
    for (int n = 0; n < 10; ++n)
      coarse.step(squeeze(-0.3));
    for (int n = 0; n < 3000; ++n)
      fine.step(squeeze(-1e-3));
    EXPECT_NEAR(von_mises(coarse.stress), von_mises(fine.stress), 1e-5 * p0);
  }
}

constexpr Control rate(Real value) { return {Controlled::strain_rate, value}; }
constexpr Control held(Real value) { return {Controlled::stress, value}; }

/// Axial (zz) strain in units of soil strains under constant cell pressure p.
std::vector<PointRow> triaxial(const ModifiedCamClay& law, Real axial_strain, Real p)
{
  const PointPath path{.steps = 1000, .controls = {.xx = held(-p), .yy = held(-p), .zz = rate(axial_strain / stiffening)}};
  return drive(make_material(law, 0, 1, "sample"), {&path, 1}, -p * Mat3::Identity()).rows;
}

TEST(ModifiedCamClay, DrainedTriaxialTestsEndAtTheCriticalState)
{
  for (const Real M : {0.8, 1.0, 1.3})
    for (const Real p : {p0, 0.5 * p0, 0.1 * p0}) {  // OCR 1, 2, 10
      ModifiedCamClay law = stiff_clay();
      law.critical_state_slope = M;
      const auto rows = triaxial(law, -3, p);
      EXPECT_NEAR(rows.back().q, 3 * M * p / (3 - M), 1e-6 * p) << M << " " << p;
      EXPECT_NEAR(rows.back().p, 3 * p / (3 - M), 1e-6 * p);
      const Vec3 last = rows.back().F.diagonal() - rows[rows.size() - 100].F.diagonal();
      EXPECT_NEAR(last.sum() / last[2], 0, 1e-3) << "no change of volume, up to the rounding of F against strains of 1e-10";
      Real peak = 0;
      for (const auto& row : rows)
        peak = std::max(peak, row.q);
      if (p < 0.2 * p0)
        EXPECT_GT(peak, 1.2 * rows.back().q) << "clay of high overconsolidation softens";
      else
        EXPECT_LE(peak, (1 + 1e-6) * rows.back().q);
    }
  const Real extension = triaxial(stiff_clay(), 3, p0).back().q;
  EXPECT_NEAR(extension, 3 * p0 / (3 + 1), 1e-6 * p0) << "the ellipse does not see Lode's angle";
}

TEST(ModifiedCamClay, ElasticityIsThatOfItsPotential)
{
  auto point = consolidated(clay(), 4e4);
  const Mat3 start = point.stress;
  const Real G = point.law.shear_modulus;
  constexpr Real h = 1e-7;
  auto denser = point, sheared = point;
  denser.step(swell(-h));
  EXPECT_NEAR((kirchhoff_pressure(denser) - 4e4) / h, (4e4 + 1e4) / 0.02, 1e-5 * 2.5e6);  // h / kappa
  Mat3 shear = Mat3::Identity();
  shear(0, 1) = h;
  sheared.step(shear);
  EXPECT_NEAR(sheared.stress(0, 1) / h, G, 1e-5 * G);
  EXPECT_NEAR(pressure(sheared.stress), 4e4, 1e-9 * 4e4) << "pressure does not know shear";
  for (const Real turn : {0.0, 1.0, 2.0, 3.0})
    point.step(Mat3(swell(1e-3 * std::cos(turn * std::acos(0.0)))) * squeeze(1e-3 * std::sin(turn * std::acos(0.0))));
  EXPECT_EQ(point.state.plastic_strain, 0);
  EXPECT_LE((point.stress - start).norm(), 1e-12 * G);
}

TEST(ModifiedCamClay, AnswersAnyTrialStateOnTheEllipseWithAssociatedFlow)
{
  Dice dice(1);
  int wet = 0, dry = 0, open = 0;
  constexpr int trials = 100000;
  for (int n = 0; n < trials; ++n) {
    ModifiedCamClay law = clay();
    law.critical_state_slope = dice.real(0.3, 2);
    law.swelling_index = 0.1 * std::pow(10, dice.real(-3, -0.01));
    law.reference_pressure = std::pow(10, dice.real(1, 6));
    law.shear_modulus = std::pow(10, dice.real(5, 9));
    Point<ModifiedCamClay> point{.law = law};
    point.state.plastic_volume = dice.real(-3, 3) * (law.compression_index - law.swelling_index);
    point.state.opened_volume = n % 5 == 0 ? std::pow(10, dice.real(-8, -1)) : 0;
    const Mat3 left = dice.symmetric(std::pow(10, dice.real(-7, -2)));
    point.state.elastic_left = pack(left - dice.real(0, 2 * law.swelling_index) * Mat3::Identity());
    const Real size = std::pow(10, dice.real(-8, -1));
    const Mat3 H = n % 10 == 0 ? Mat3(dice.real(-size, size) * Mat3::Identity()) : dice.matrix(size);  // no shear every tenth time
    const auto before = point.state;
    const Sym3 trial = 0.5 * log1p(push_forward(H, before.elastic_left));
    point.strain(H);
    ASSERT_TRUE(point.stress.allFinite()) << n;
    const auto& now = point.state;
    const Real J = point.F.determinant(), p = J * pressure(point.stress), q = J * von_mises(point.stress), pc = preconsolidation(point);
    const Real M = law.critical_state_slope;
    ASSERT_LE(law.yield(point.stress, now), machine * (pc + law.reference_pressure)) << n;
    ASSERT_GE(p, 0);
    ASSERT_GE(now.plastic_work, before.plastic_work);
    ASSERT_GE(now.plastic_strain, before.plastic_strain);
    ASSERT_GE(now.opened_volume, 0);
    if (now.opened_volume > 0) {
      ++open;
      ASSERT_EQ(point.stress.norm(), 0);
      ASSERT_EQ(now.plastic_volume, before.plastic_volume) << "an open gap is no dilation";
      continue;
    }
    const Real compacted = before.plastic_volume - now.plastic_volume, sheared = now.plastic_strain - before.plastic_strain;
    if (compacted == 0 || p == 0)
      continue;
    ++(compacted > 0 ? wet : dry);
    const Real strain_rounding = 1e-15 * size * (p + law.reference_pressure) / law.swelling_index;
    ASSERT_NEAR((q * q / (M * M) + p * (p - pc)) / (pc * pc), 0, machine + strain_rounding / pc) << n;
    ASSERT_NEAR(p, law.reference_pressure * std::expm1(-(trace(trial) + before.opened_volume + compacted) / law.swelling_index),
                1e-9 * (p + law.reference_pressure));
    // Both parts of the flow follow one multiplier: compacted / (2 p - pc) = sheared M^2 / (2 q).
    const Real f_p = 2 * p - pc, f_q = 2 * q / (M * M);
    const Real blur = f_q * 1e-15 * std::abs(now.plastic_volume) + sheared * (strain_rounding + 1e-14 * pc);  // of differences
    ASSERT_NEAR(compacted * f_q, sheared * f_p, 1e-5 * std::abs(sheared * f_p) + blur)
        << n;  // the root, by its distance to the critical state
  }
  EXPECT_GT(wet, 5000);
  EXPECT_GT(dry, 5000);
  EXPECT_GT(open, 5000);
}

TEST(ModifiedCamClay, SeparatedClayStaysFreeOfStressUntilItClosesAndKeepsItsPreconsolidation)
{
  auto point = consolidated(clay(), 2e4);
  const Real elastic = 0.02 * std::log(1 + 2e4 / 1e4);
  point.step(swell(0.3 + elastic));
  EXPECT_EQ(point.stress.norm(), 0);
  EXPECT_NEAR(point.state.opened_volume, 0.3, 1e-14);
  point.step(squeeze(0.05));
  EXPECT_EQ(point.stress.norm(), 0) << "shear of what is apart";
  point.step(swell(-0.2));
  EXPECT_EQ(point.stress.norm(), 0);
  EXPECT_NEAR(point.state.opened_volume, 0.1, 1e-14);
  point.step(swell(-0.1 - elastic));
  EXPECT_EQ(point.state.opened_volume, 0);
  EXPECT_NEAR(kirchhoff_pressure(point), 2e4, 1e-13 / 0.02 * 3e4);  // rounding of the strain times the bulk modulus
  EXPECT_EQ(preconsolidation(point), p0);
  EXPECT_EQ(point.state.plastic_work, 0);
}

TEST(ModifiedCamClay, ShearFromRestMakesNoStress)
{
  Dice dice(2);
  Point<ModifiedCamClay> point{.law = clay()};
  for (int n = 0; n < 100; ++n) {
    const Mat3 Q = dice.rotation();
    point.step(Q * squeeze(dice.real(-0.01, 0.01)) * Q.transpose());
    ASSERT_EQ(point.stress.norm(), 0);
  }
}

TEST(ModifiedCamClay, OpeningOfShearedClayIsTheLimitOfDilation)
{
  // Extension of sheared clay near zero pressure: the smaller the steps, the less stress is left when it opens.
  const auto lost = [](Real step) {
    auto point = consolidated(clay(), 5e3);
    point.step(squeeze(1e-3));
    Real last = 0;
    while (point.stress.norm() > 0) {
      last = von_mises(point.stress);
      point.step(swell(step));
    }
    return last;
  };
  const Real coarse = lost(1e-3), fine = lost(1e-5);
  for (const auto& [q, step] : {std::pair{coarse, 1e-3}, std::pair{fine, 1e-5}})
    EXPECT_LE(q, std::sqrt(1e4 / 0.02 * step * p0)) << "M sqrt(K de pc)";
  EXPECT_GT(fine, 0);
}

TEST(ModifiedCamClay, PrestressInsideTheEllipseKeepsThePreconsolidationAndOutsideRaisesIt)
{
  auto inside = consolidated(clay(), 4e4), outside = consolidated(clay(), 3e5);
  EXPECT_EQ(inside.state.plastic_volume, 0);
  EXPECT_NEAR(preconsolidation(outside), 3e5, machine * 3e5);
  Point<ModifiedCamClay> sheared{.law = clay()}, pulled{.law = clay()};
  const Mat3 start = Vec3(-5e4, -5e4, -1.4e5).asDiagonal();  // p = 80 kPa, q = 90 kPa
  sheared.prestress(start);
  EXPECT_NEAR(preconsolidation(sheared), 8e4 + 9e4 * 9e4 / 8e4, machine * 2e5);
  for (auto* point : {&inside, &outside, &sheared}) {
    const Mat3 before = point->stress;
    point->step(Mat3::Identity());
    EXPECT_LE((point->stress - before).norm(), machine * before.norm());
  }
  pulled.prestress(2e4 * Mat3::Identity());
  pulled.step(Mat3::Identity());
  EXPECT_EQ(pulled.stress.norm(), 0);
}

TEST(ModifiedCamClay, PrestressKeepsThePreconsolidationThatThereWas)
{
  auto hardened = consolidated(clay(), 3e5);
  hardened.prestress(-2e5 * Mat3::Identity());
  EXPECT_NEAR(preconsolidation(hardened), 3e5, machine * 3e5);
}

TEST(ModifiedCamClay, WaveSpeedOfTheHistoryBoundsThatOfTheStress)
{
  Dice dice(3);
  for (int n = 0; n < 300; ++n) {
    auto point = consolidated(clay(), std::pow(10, dice.real(2, 5.5)));
    for (int step = 0; step < n % 7; ++step)
      point.step(Mat3::Identity() + dice.matrix(0.01) - 0.003 * Mat3::Identity());
    const Real bound = point.law.wave_speed(point.F, point.state, point.constants);
    const Vec3 along = dice.direction();
    constexpr Real h = 1e-7;
    const auto stress_after = [&](Real size) {
      auto moved = point;
      moved.step(Mat3::Identity() + size * along * along.transpose(), true);
      return along.dot(moved.stress * along);
    };
    const Real modulus = (stress_after(h) - stress_after(-h)) / (2 * h);  // the cross-section stays: nominal stress
    const Real density = point.law.density / point.F.determinant();
    ASSERT_LE(std::sqrt(modulus / density), (1 + 1e-6) * bound) << n;
  }
  const auto point = consolidated(clay(), p0);
  const Real K = (p0 + 1e4) / 0.02, G = 3e6;
  EXPECT_NEAR(std::pow(point.law.wave_speed(point.F, point.state, point.constants), 2), (K + 4 * G / 3 + p0) / 1800, machine * K);
}

TEST(ModifiedCamClay, SuperposedRotationTurnsTheStressWhileItYields)
{
  Dice dice(4);
  for (int path = 0; path < 200; ++path) {
    auto still = consolidated(clay(), path % 2 ? p0 : 1e4), turned = still;
    const Mat3 Q = dice.rotation();
    for (int n = 0; n < 5; ++n) {
      const Mat3 f = Mat3::Identity() + dice.matrix(0.02);
      still.step(f);
      turned.step(Q * f * Q.transpose());
      ASSERT_LE((turned.stress - Q * still.stress * Q.transpose()).norm(), 1e-12 * (still.stress.norm() + 1e7));
    }
    EXPECT_GT(still.state.plastic_strain, 0);
  }
}

TEST(ModifiedCamClayRules, ContradictionsAreToldInWords)
{
  using Problems = std::vector<std::string>;
  Problems found;
  ModifiedCamClay law = clay();
  law.check(found);
  EXPECT_EQ(found, Problems{});
  law.swelling_index = 0.1;
  law.check(found);
  EXPECT_EQ(found, Problems{"compression_index 0.1 must be above swelling_index 0.1"});
}

TEST(ModifiedCamClay, WaveSpeedsOfFourAtOnceAreThoseOfEach)
{
  const ModifiedCamClay law = clay();
  const ModifiedCamClay::Constants constants = law.constants();
  Dice dice(7);
  std::array<Real, static_cast<std::size_t>(numbers_of_state<ModifiedCamClay::State>) * pack_size> history;
  const StateLanes<ModifiedCamClay::State> states{history.data(), pack_size, pack_size};
  for (int lane = 0; lane < pack_size; ++lane) {
    Point<ModifiedCamClay> point = consolidated(law, p0 * lane);
    point.step(Mat3::Identity() + dice.matrix(0.01));
    states.set(lane, point.state);
  }
  const SimdReal together = law.wave_speed(Mat3Of<SimdReal>(Mat3Of<SimdReal>::Identity()), states, constants);
  for (int lane = 0; lane < pack_size; ++lane) {
    const Real alone = law.wave_speed(Mat3(Mat3::Identity()), states.of(lane), constants);
    EXPECT_NEAR(together[lane], alone, 1e-13 * alone) << lane;
  }
}

}  // namespace
}  // namespace talus::modified_cam_clay_test
