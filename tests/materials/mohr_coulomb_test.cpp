// The planes, edges, corners and apex of Mohr and Coulomb against closed forms.  Stiffnesses are 1e10 times those of soil where the
// closed form is one of small strain: strains of 1e-11 make Kirchhoff and Cauchy stress equal to the tolerance, and cost no digits.
#include "tests/materials/mohr_coulomb_samples.hpp"

namespace talus::mohr_coulomb_test {
namespace {

TEST(MohrCoulomb, TriaxialStrengthsAreThoseOfTheBook)
{
  for (const Real psi : {0.0, 10.0, 30.0}) {
    const MohrCoulomb law = soil(30, 5e3, psi);
    const Real sine = 0.5, strength = 2 * (5e3 * std::cos(radians(30)) + p0 * sine);
    EXPECT_NEAR(triaxial(law, -0.2).back().q, strength / (1 - sine), machine * p0);
    EXPECT_NEAR(triaxial(law, 0.2).back().q, strength / (1 + sine), machine * p0);
    EXPECT_NEAR(triaxial(law, -0.2).back().q, 217320.5, 0.06);
    EXPECT_NEAR(triaxial(law, 0.2).back().q, 72440.2, 0.06);
  }
}

TEST(MohrCoulomb, PlaneStrainStrengthDoesNotDependOnTheStressOutOfPlane)
{
  for (const Real psi : {0.0, 10.0, 30.0}) {
    const Mat3 end = test_of(soil(30, 5e3, psi), {.xx = held(-p0), .zz = rate(-0.08 / stiffening)}, 100).back().stress;
    EXPECT_NEAR(end(0, 0) - end(2, 2), 217320.5, 0.06) << psi;
    EXPECT_GT(end(1, 1), end(2, 2));
    EXPECT_LT(end(1, 1), end(0, 0));
  }
}

TEST(MohrCoulomb, VolumeGrowsByTheAngleOfDilation)
{
  // Softer than the others, for strains of 1e-5, hundreds of times those at yield; rounding of F in 1000 steps leaves 1e-8 of them.
  constexpr Real softer = 1e-4, tolerance = 1e-7;
  MohrCoulomb law = soil(30, 5e3, 10);
  *law.youngs_modulus *= softer;
  const auto slope = [&](Controls controls, Real axial_strain) {
    controls.zz = rate(axial_strain / (stiffening * softer));
    const auto rows = test_of(law, controls, 2000);
    const Vec3 change = log_strain(rows.back()) - log_strain(rows[1000]);
    return change.sum() / change[2];
  };
  const Controls cell{.xx = held(-p0), .yy = held(-p0)};
  const Real sine = std::sin(radians(10));
  EXPECT_NEAR(slope(cell, -10), -2 * sine / (1 - sine), tolerance);
  EXPECT_NEAR(slope(cell, -10), -0.420277, 1e-6);
  EXPECT_NEAR(slope(cell, 10), 2 * sine / (1 + sine), tolerance);
  EXPECT_NEAR(slope({.xx = held(-p0)}, -10), -2 * sine / (1 - sine), tolerance);
}

TEST(MohrCoulomb, OedometerIsElasticOrAtActiveEarthPressure)
{
  const auto k0 = [](const MohrCoulomb& law) {
    const Mat3 end = test_of(law, {.zz = rate(-0.02 / stiffening)}, 20, Mat3::Zero()).back().stress;
    EXPECT_EQ(end(0, 0), end(1, 1));
    return end(0, 0) / end(2, 2);
  };
  EXPECT_NEAR(k0(soil(30, 0)), 0.3 / 0.7, machine) << "above Rankine's 1/3";
  const Real rankine = (1 - std::sin(radians(20))) / (1 + std::sin(radians(20)));
  ASSERT_GT(rankine, 0.3 / 0.7);
  EXPECT_NEAR(k0(soil(20, 0)), rankine, machine);
  EXPECT_NEAR(k0(soil(20, 0, 20)), rankine, machine);
}

/// Friction tau/sigma_n and dilation d eps_y/d gamma of drained simple shear at the end.
std::array<Real, 2> drained_simple_shear(const MohrCoulomb& law)
{
  const auto rows = test_of(law, {.yy = held(-p0), .xy = gradient(3e6 / stiffening)}, 1500);
  const auto &last = rows.back(), &before = rows[rows.size() - 500];
  return {last.stress(0, 1) / -last.stress(1, 1), std::log(last.F(1, 1) / before.F(1, 1)) / (last.F(0, 1) - before.F(0, 1))};
}

TEST(MohrCoulomb, SimpleShearMobilisesTheFrictionOfDavis)
{
  // tan(beta) = sin(phi) cos(psi) / (1 - sin(phi) sin(psi)): Davis 1968, in Lee (ed.), Soil Mechanics: Selected Topics, 341.
  for (const auto& [phi, psi] : {std::array{30.0, 0.0}, std::array{30.0, 30.0}, std::array{35.0, 12.0}, std::array{20.0, 5.0}}) {
    const auto [friction, dilation] = drained_simple_shear(soil(phi, 0, psi));
    const Real sine = std::sin(radians(phi)), flow = radians(psi);
    EXPECT_NEAR(friction, sine * std::cos(flow) / (1 - sine * std::sin(flow)), 2e-6) << phi << " " << psi;
    EXPECT_NEAR(dilation, std::tan(flow), 1e-3 * std::tan(flow) + 1e-6) << phi << " " << psi;
  }
  EXPECT_NEAR(std::atan(drained_simple_shear(soil(30, 0))[0]) / radians(1), 26.57, 0.006);
  EXPECT_NEAR(drained_simple_shear(soil(30, 0, 30))[0], std::tan(radians(30)), 2e-6);
}

TEST(MohrCoulomb, IsTheOuterConeInTriaxialCompressionAndTheInnerInExtension)
{
  for (const auto& [match, sign] : {std::pair{ConeMatch::outer, -1.0}, std::pair{ConeMatch::inner, 1.0}}) {
    Point<MohrCoulomb> planes{.law = soft_soil(30, 5e3, 10)};
    Point<DruckerPrager> cone{.law = testing::soft_soil(match, 30, 5e3, 10)};
    planes.prestress(-p0 * Mat3::Identity());
    cone.prestress(-p0 * Mat3::Identity());
    for (int n = 0; n < 100; ++n) {
      const Mat3 f = Vec3(1 - sign * 4e-4, 1 - sign * 4e-4, 1 + sign * 1e-3).asDiagonal();
      planes.step(f);
      cone.step(f);
      ASSERT_LE((planes.stress - cone.stress).norm(), machine * p0);
    }
    EXPECT_GT(planes.state.plastic_strain, 0.04);
    EXPECT_NEAR(planes.state.plastic_strain, cone.state.plastic_strain, machine);
    EXPECT_NEAR(planes.state.plastic_work, cone.state.plastic_work, machine * p0);
    EXPECT_LE((planes.state.elastic_left - cone.state.elastic_left).norm(), machine * 0.1);
  }
}

/// Smallest |flow x - strain| / |strain| over x >= 0, by all sets of up to three columns.
Real distance_from_cone(const std::vector<Vec3>& flow, const Vec3& strain)
{
  Real least = strain.norm();
  const auto attempt = [&](const Eigen::MatrixXd& columns) {
    const Eigen::VectorXd x = columns.completeOrthogonalDecomposition().solve(Eigen::VectorXd(strain));
    if (x.minCoeff() >= -machine * strain.norm())
      least = std::min(least, (columns * x - strain).norm());
  };
  for (std::size_t a = 0; a < flow.size(); ++a)
    for (std::size_t b = a; b < flow.size(); ++b)
      for (std::size_t d = b; d < flow.size(); ++d) {
        Eigen::MatrixXd columns(3, 3);
        columns << flow[a], flow[b], flow[d];
        if (b == a)
          attempt(columns.leftCols(1));
        else
          attempt(columns.leftCols(d == b ? 2 : 3));
      }
  return least / strain.norm();
}

/// Flow vectors of what is active at principal stresses `s`, in their order.
std::vector<Vec3> active_flow(const MohrCoulomb& law, const Vec3& s, Real tolerance)
{
  const auto c = law.constants();
  std::vector<Vec3> flow;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (i != j && (s[i] - s[j]) + (s[i] + s[j]) * c.peak.sine - 2 * c.peak.cohesive > -tolerance) {
        flow.emplace_back(Vec3::Zero());
        flow.back()[i] = 1 + c.sin_psi;
        flow.back()[j] = -(1 - c.sin_psi);
      }
  if (flow.size() == 6)  // the apex opens
    flow.emplace_back(Vec3::Ones());
  for (int i = 0; i < 3; ++i)
    if (s[i] > c.cutoff - tolerance)
      flow.emplace_back(Vec3::Unit(i));
  return flow;
}

TEST(MohrCoulomb, PlasticStrainIsMadeOfTheFlowOfActivePlanes)
{
  // Koiter's rule, whatever the region: independent of how the return finds it.
  Dice dice(1);
  const std::vector<MohrCoulomb> soils{soil(30, 5e3, 12),
                                       soil(30, 5e3),
                                       soil(40, 0, 40),
                                       soil(0, 5e3),
                                       soil(25, 5e3),
                                       with_cutoff(soil(30, 5e3, 12), 2e3),
                                       with_cutoff(soil(30, 5e3), 0),
                                       with_cutoff(soil(0, 5e3), 4e3)};
  std::array<int, 8> regions{};
  for (int n = 0; n < 8000; ++n) {
    const MohrCoulomb& law = soils[static_cast<std::size_t>(n) % soils.size()];
    const auto c = law.constants();
    const Real size = std::pow(10.0, dice.real(3, 6));
    Vec3 trial = Vec3::NullaryExpr([&] { return dice.real(-size, size); }) + dice.real(-2, 1) * size * Vec3::Ones();
    if (n % 5 == 0)
      trial[1] = trial[n % 2 == 0 ? 0 : 2];
    const Mat3 axes = dice.rotation(), wanted = axes * trial.asDiagonal() * axes.transpose();
    Point<MohrCoulomb> point{.law = law};
    point.strain(dev(wanted) / (2 * c.shear) + wanted.trace() / (9 * c.bulk) * Mat3::Identity());
    const Mat3 along = axes.transpose() * point.stress * axes, gone = Mat3(trial.asDiagonal()) - along;
    const Vec3 end = along.diagonal(), plastic = (dev(gone) / (2 * c.shear) + gone.trace() / (9 * c.bulk) * Mat3::Identity()).diagonal();
    ASSERT_LE((along - Mat3(end.asDiagonal())).norm(), machine * size) << "not along the axes of the trial state";
    ASSERT_LE(law.yield(point.stress, point.state), machine * size);
    if (plastic.norm() < 1e-8 * size / c.shear)
      continue;
    const auto flow = active_flow(law, end, 1e-9 * size);
    ++regions[std::min(flow.size(), regions.size() - 1)];
    ASSERT_LE(distance_from_cone(flow, plastic), 1e-7) << n << ": " << trial.transpose() << " to " << end.transpose();
    const Real deviatoric = std::sqrt(2.0 / 3) * (plastic.array() - plastic.mean()).matrix().norm();
    ASSERT_NEAR(point.state.plastic_strain, deviatoric, machine * size / c.shear);
    ASSERT_NEAR(point.state.plastic_work, end.dot(plastic), machine * size * size / c.shear);
  }
  for (const std::size_t active : {1u, 2u, 3u, 4u, 7u})
    EXPECT_GT(regions[active], 50) << active << " active planes";
}

TEST(MohrCoulomb, EndsOnOrInsideTheYieldSurfaceFromAnyTrialState)
{
  Dice dice(2);
  const std::vector<MohrCoulomb> soils{soil(0, 5e3),
                                       soil(30, 0, 30),
                                       soil(0, 0),
                                       with_cutoff(soil(35, 5e3, 10), 2e3),
                                       with_cutoff(soil(35, 5e3, 10), 5e3 / std::tan(radians(35)) * (1 - 1e-15)),
                                       softening(soil(35, 5e3, 10), 20, 0, 0.01 / stiffening),
                                       softening(with_cutoff(soil(35, 5e3, 15), 6e3), 15, 4e3, 0.03 / stiffening),
                                       softening(soil(60, 5e3), 0, 5e3, 0.03 / stiffening)};
  constexpr int trials = 100000;
  for (int n = 0; n < trials; ++n) {
    const MohrCoulomb& law = soils[static_cast<std::size_t>(n) % soils.size()];
    Point<MohrCoulomb> point{.law = law};
    point.state.plastic_strain = dice.real(0, 0.02) / stiffening;
    point.state.opened_volume = n % 3 == 0 ? dice.real(0, 1e-3) / stiffening : 0;
    const Real size = std::pow(10.0, dice.real(-12, 0)) / stiffening;
    Mat3 H = dice.matrix(size);
    if (n % 10 == 0)  // equal principal stresses: all three, or two of them along the axes
      H = n % 20 == 0 ? Mat3(dice.real(-size, size) * Mat3::Identity()) : Mat3(Vec3(H(0, 0), H(1, 1), H(0, 0)).asDiagonal());
    const Real before = point.state.plastic_strain;
    const Real trial_stress = law.constants().bulk * (H.norm() + point.state.opened_volume);
    point.strain(H);
    ASSERT_TRUE(point.stress.allFinite());
    ASSERT_LE(law.yield(point.stress, point.state), machine * trial_stress) << n;
    ASSERT_GE(point.state.plastic_strain, before);
    ASSERT_GE(point.state.plastic_work, 0);
    ASSERT_GE(point.state.opened_volume, 0);
  }
}

TEST(MohrCoulomb, YieldsWhereTheExactSurfaceSaysSo)
{
  Dice dice(3);
  int inside = 0;
  for (int n = 0; n < 20000; ++n) {
    Point<MohrCoulomb> point{.law = with_cutoff(soil(30, 5e3, 10), 3e3)};
    Mat3 stress = dice.symmetric(6e4);
    if (n % 4 == 0)
      stress = Vec3(stress(0, 0), stress(0, 0), stress(1, 1)).asDiagonal();
    point.prestress(stress - 5e4 * Mat3::Identity());
    const Real f = point.law.yield(point.stress, point.state);
    point.strain(Mat3::Zero());
    if (f < 0) {
      ASSERT_EQ(point.state.plastic_strain, 0) << n;
    }
    if (f > 1e-8 * p0) {
      ASSERT_GT(point.state.plastic_strain, 0) << n;
    }
    inside += f < 0;
  }
  EXPECT_GT(inside, 4000);
  EXPECT_LT(inside, 16000);
}

TEST(MohrCoulomb, PlasticWorkIsStressTimesPlasticShear)
{
  Point<MohrCoulomb> point{.law = soil(25, 8e3)};
  point.prestress(-5e4 * Mat3::Identity());
  const auto c = point.law.constants();
  const Real strength = c.peak.cohesive + c.peak.sine * 5e4, gamma = 0.05 / stiffening;
  Mat3 H = Mat3::Zero();
  H(0, 1) = gamma / 20;
  for (int n = 0; n < 20; ++n)
    point.strain(H);
  const Real plastic = gamma - strength / c.shear;
  EXPECT_NEAR(point.stress(0, 1), strength, machine * strength);
  EXPECT_NEAR(point.state.plastic_strain, plastic / root3, machine * plastic);
  EXPECT_NEAR(point.state.plastic_work, strength * plastic, machine * strength * plastic);
}

TEST(MohrCoulomb, QuarterTurnInAnyNumberOfStepsKeepsPrincipalStresses)
{
  const Mat3 start = Vec3(-1e5, -6e4, -8e4).asDiagonal();
  for (const int steps : {1, 10, 100}) {
    Point<MohrCoulomb> point{.law = soft_soil(40, 5e3)};
    point.prestress(start);
    for (int n = 0; n < steps; ++n)
      point.step(testing::rotation_about(Vec3::UnitZ(), std::acos(0.0) / steps));
    EXPECT_LE((point.stress - Mat3(Vec3(-6e4, -1e5, -8e4).asDiagonal())).norm(), 1e-15 * steps * 1e7);  // rounding of f - I times E
  }
}

TEST(MohrCoulomb, SuperposedRotationTurnsTheStressWhileItYields)
{
  Dice dice(4);
  for (int path = 0; path < 200; ++path) {
    Point<MohrCoulomb> still{.law = soft_soil(30, 5e3, 10)}, turned = still;
    const Mat3 Q = dice.rotation();
    for (int n = 0; n < 5; ++n) {
      const Mat3 f = Mat3::Identity() + dice.matrix(0.02);
      still.step(f);
      turned.step(Q * f * Q.transpose());
      ASSERT_LE((turned.stress - Q * still.stress * Q.transpose()).norm(), 1e-13 * 1e7);  // rounding of strains times E
    }
  }
}

TEST(MohrCoulombRules, ContradictionsAreToldInWords)
{
  const auto problems = [](auto change) { return testing::problems_of(soil(30, 5e3, 10), change); };
  using testing::Problems;
  EXPECT_EQ(problems([](auto&) {}), Problems{});
  EXPECT_EQ(problems([](auto& law) { law.dilation_angle = 31; }), Problems{"dilation_angle 31 is above friction_angle 30"});
  EXPECT_EQ(problems([](auto& law) { law.tension_cutoff = 9e3; }), Problems{"tension_cutoff 9000 is above the apex, 8660.25 Pa"});
  EXPECT_EQ(problems([](auto& law) { law.residual_cohesion = 6e3, law.softening_strain = 0.1; }),
            Problems{"residual_cohesion 6000 is above cohesion 5000"});
  EXPECT_EQ(problems([](auto& law) { law.residual_cohesion = 0; }),
            Problems{"residual_friction_angle and residual_cohesion need softening_strain"});
  EXPECT_EQ(problems([](auto& law) { law.softening_strain = 0.1; }),
            Problems{"softening_strain needs residual_friction_angle or residual_cohesion"});
  EXPECT_EQ(problems([](auto& law) { law.residual_friction_angle = 5, law.softening_strain = 0.1; }),
            Problems{"dilation_angle 10 is above residual_friction_angle 5"});
  EXPECT_EQ(problems([](auto& law) { law.residual_friction_angle = 35, law.softening_strain = 0.1; }),
            Problems{"residual_friction_angle 35 is above friction_angle 30"});
  EXPECT_EQ(problems([](auto& law) { law.bulk_modulus = 1e7; }).size(), 1u) << "elastic constants in three";
}

}  // namespace
}  // namespace talus::mohr_coulomb_test
