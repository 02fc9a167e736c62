// Laboratory tests on one point, against strengths and flow rules in closed form.
#include "materials/laboratory/point_path.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "tests/materials/soil.hpp"

namespace talus::point_path_test {
namespace {

using testing::radians;
using testing::sample;
using testing::soil;
using testing::stiffening;

constexpr Control rate(Real value) { return {Controlled::strain_rate, value}; }
constexpr Control gradient(Real value) { return {Controlled::velocity_gradient, value}; }
constexpr Control stress(Real value) { return {Controlled::stress, value}; }
const Real root3 = std::sqrt(3.0);
constexpr Real p0 = 1e5;

template <class L>
PointTable drive_one(const L& law, const PointPath& path, const Mat3& start = Mat3::Zero())
{
  return drive(make_material(law, 0, 1, "sample"), {&path, 1}, start);
}

/// Axial (zz) strain in units of soil strains under constant cell pressure p0.
PointTable triaxial(const DruckerPrager& law, Real axial_strain, Index steps)
{
  const PointPath path{.steps = steps, .controls = {.xx = stress(-p0), .yy = stress(-p0), .zz = rate(axial_strain / stiffening)}};
  return drive_one(law, path, -p0 * Mat3::Identity());
}

TEST(TriaxialTest, StrengthsAreThoseOfTheMatch)
{
  const auto compression = [](const Cone& c) { return root3 * (c.k + c.q * p0) / (1 - c.q / root3); };
  const auto extension = [](const Cone& c) { return root3 * (c.k + c.q * p0) / (1 + c.q / root3); };
  for (const ConeMatch match : {ConeMatch::outer, ConeMatch::inner, ConeMatch::plane_strain}) {
    const DruckerPrager law = soil(match, 30, 5e3);
    EXPECT_NEAR(triaxial(law, -0.2, 50).rows.back().q / compression(law.cone(0)), 1, 1e-9);
    EXPECT_NEAR(triaxial(law, 0.2, 50).rows.back().q / extension(law.cone(0)), 1, 1e-9);
  }
  EXPECT_NEAR(triaxial(soil(ConeMatch::outer, 30, 5e3), -0.2, 50).rows.back().q, 217320.5, 0.06);
  EXPECT_NEAR(triaxial(soil(ConeMatch::inner, 30, 5e3), 0.2, 50).rows.back().q, 72440.2, 0.06);
  EXPECT_NEAR(triaxial(soil(ConeMatch::inner, 30, 5e3), -0.2, 50).rows.back().q, 130392.3, 0.06);
}

TEST(TriaxialTest, VolumeGrowsByTheAngleOfDilation)
{
  const auto rows = triaxial(soil(ConeMatch::outer, 30, 5e3, 10), -1e8, 20).rows;
  const auto strain = [](const PointRow& row) { return Vec3(row.F.diagonal().array().log()); };
  const Vec3 change = strain(rows.back()) - strain(rows[10]);
  const Real sine = std::sin(radians(10));
  EXPECT_NEAR(change.sum() / change[2], -2 * sine / (1 - sine), 1e-7);
}

/// Deviator stress of a drained test in plane strain (no strain along y) at an axial strain.
Real plane_strain_strength(const DruckerPrager& law, Real axial_strain)
{
  const PointPath path{.steps = 400, .controls = {.xx = stress(-p0), .zz = rate(-axial_strain / stiffening)}};
  const Mat3 end = drive_one(law, path, -p0 * Mat3::Identity()).rows.back().stress;
  return end(0, 0) - end(2, 2);
}

TEST(PlaneStrainTest, OuterConeIsTwiceTooStrong)
{
  EXPECT_NEAR(plane_strain_strength(soil(ConeMatch::outer, 30, 5e3), 0.08), 442490, 50);
  const Real mohr_coulomb = 2 * (5e3 * std::cos(radians(30)) + p0 * 0.5) / (1 - 0.5);
  for (const Real psi : {0.0, 10.0, 30.0})
    EXPECT_NEAR(plane_strain_strength(soil(ConeMatch::plane_strain, 30, 5e3, psi), 2) / mohr_coulomb, 1, 1e-6) << psi;
}

TEST(Oedometer, CoefficientOfEarthPressureIsElasticOrThatOfTheCone)
{
  const auto k0 = [](const DruckerPrager& law) {
    const Mat3 end = drive_one(law, {.steps = 20, .controls = {.zz = rate(-0.02 / stiffening)}}).rows.back().stress;
    return end(0, 0) / end(2, 2);
  };
  const Real limit = root3 * (1 - 2 * 0.3) / (1 + 0.3);
  const DruckerPrager strong = soil(ConeMatch::outer, 30, 0), weak = soil(ConeMatch::inner, 30, 0);
  ASSERT_GT(strong.cone(0).q, limit);
  ASSERT_LT(weak.cone(0).q, limit);
  EXPECT_NEAR(k0(strong), 0.3 / 0.7, 1e-10);
  EXPECT_NEAR(k0(weak), (1 - weak.cone(0).q / root3) / (1 + 2 * weak.cone(0).q / root3), 1e-10);
  EXPECT_NEAR(k0(weak), 0.454545, 1e-6);
  const DruckerPrager loose = soil(ConeMatch::outer, 15, 0);
  EXPECT_NEAR(k0(loose), (1 - std::sin(radians(15))) / (1 + std::sin(radians(15))), 1e-10) << "the outer cone gives Rankine's";
}

/// Friction tau/sigma_n and dilation d eps_y/d gamma of drained simple shear at the end.
std::array<Real, 2> drained_simple_shear(const DruckerPrager& law)
{
  const PointPath path{.steps = 1500, .controls = {.yy = stress(-p0), .xy = gradient(3e6 / stiffening)}};
  const auto rows = drive_one(law, path, -p0 * Mat3::Identity()).rows;
  const auto &last = rows.back(), &before = rows[rows.size() - 500];
  return {last.stress(0, 1) / -last.stress(1, 1), std::log(last.F(1, 1) / before.F(1, 1)) / (last.F(0, 1) - before.F(0, 1))};
}

TEST(SimpleShearTest, MobilisesTheFrictionOfAnInfiniteSlope)
{
  const auto check = [](const DruckerPrager& law) {
    const Real q = law.cone(0).q, q_psi = law.dilation_slope();
    const auto [friction, dilation] = drained_simple_shear(law);
    EXPECT_NEAR(friction, q * std::sqrt(1 - 4 * q_psi * q_psi / 3) / (1 - 4 * q * q_psi / 3), 2e-6);
    EXPECT_NEAR(dilation, q_psi / std::sqrt(1 - 4 * q_psi * q_psi / 3), 1e-3 * q_psi + 1e-6);
    return friction;
  };
  EXPECT_NEAR(std::atan(check(soil(ConeMatch::outer, 30, 0))) / radians(1), 34.72, 0.006);
  EXPECT_NEAR(std::atan(check(soil(ConeMatch::inner, 30, 0))) / radians(1), 26.33, 0.006);
  EXPECT_NEAR(std::atan(check(soil(ConeMatch::plane_strain, 30, 0))) / radians(1), 26.57, 0.006);
  EXPECT_NEAR(check(soil(ConeMatch::plane_strain, 30, 0, 30)), std::tan(radians(30)), 2e-6);
  check(soil(ConeMatch::plane_strain, 35, 0, 12));
  check(soil(ConeMatch::outer, 20, 0, 5));
}

TEST(MaterialsPage, StrengthsUnderTheThreeMatchesAreTheMeasuredOnes)
{
  const Real phi = radians(30), c = 5e3, sine = std::sin(phi);
  const Real strength = 2 * (c * std::cos(phi) + p0 * sine);
  std::array<std::string, 6> rows{"| slope `q` |",
                                  "| strength `k` [kPa] |",
                                  "| triaxial compression [kPa] |",
                                  "| triaxial extension [kPa] |",
                                  "| plane strain at 8 % [kPa] |",
                                  "| critical slope, c = 0 [deg] |"};
  const std::array<std::string, 6> mohr_coulomb{" - |",
                                                " - |",
                                                fmt::format(" {:.1f} |", strength / (1 - sine) / 1e3),
                                                fmt::format(" {:.1f} |", strength / (1 + sine) / 1e3),
                                                fmt::format(" {:.1f} |", strength / (1 - sine) / 1e3),
                                                " 30.0 |"};
  for (std::size_t r = 0; r < rows.size(); ++r)
    rows[r] += mohr_coulomb[r];
  for (const ConeMatch match : {ConeMatch::outer, ConeMatch::inner, ConeMatch::plane_strain}) {
    const DruckerPrager law = soil(match, 30, c);
    rows[0] += fmt::format(" {:.4f} |", law.cone(0).q);
    rows[1] += fmt::format(" {:.2f} |", law.cone(0).k / 1e3);
    rows[2] += fmt::format(" {:.1f} |", triaxial(law, -0.2, 50).rows.back().q / 1e3);
    rows[3] += fmt::format(" {:.1f} |", triaxial(law, 0.2, 50).rows.back().q / 1e3);
    rows[4] += fmt::format(" {:.1f} |", plane_strain_strength(law, 0.08) / 1e3);
    rows[5] += fmt::format(" {:.1f} |", std::atan(drained_simple_shear(soil(match, 30, 0))[0]) / radians(1));
  }
  std::ifstream file(TALUS_SOURCE_DIR "/docs/reference/materials.md");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  ASSERT_FALSE(page.empty());
  for (const std::string& row : rows)
    EXPECT_NE(page.find(row), std::string::npos) << row;
}

TEST(PointPath, UniaxialStressOfNeoHookeanSolidLeavesTheSidesFree)
{
  const PointPath path{.steps = 20, .controls = {.xx = gradient(0.5), .yy = stress(0), .zz = stress(0)}};
  const auto end = drive_one(sample<NeoHookean>(), path).rows.back();
  EXPECT_NEAR(end.stress(1, 1), 0, 1e-12 * 1e7);
  // mu (l^2 - 1) + lambda ln J = 0 across, with J from F itself.
  const auto [lambda, mu] = lame(1e7, 0.3);
  EXPECT_NEAR(mu * (std::pow(end.F(1, 1), 2) - 1) + lambda * std::log(end.F.determinant()), 0, 1e-11 * 1e7);
  EXPECT_GT(end.stress(0, 0), 1e6);
}

TEST(PointPath, PathsFollowOneAnother)
{
  const std::array<PointPath, 2> paths{
      PointPath{.steps = 5, .time = 2, .controls = {.xx = stress(-p0), .yy = stress(-p0), .zz = stress(-p0)}},
      PointPath{.steps = 10, .time = 3, .controls = {.xy = gradient(1e-3)}}};
  const auto table = drive(make_material(sample<DruckerPrager>(), 0, 1, "soil"), paths);
  ASSERT_EQ(table.rows.size(), 16u);
  EXPECT_NEAR(table.rows[5].p, p0, 1e-8 * p0);
  EXPECT_NEAR(table.rows[2].p, 0.4 * p0, 1e-8 * p0);
  EXPECT_NEAR(table.rows.back().time, 5, 1e-12);
  EXPECT_NEAR(table.rows.back().F(0, 1), 3e-3 * table.rows[5].F(1, 1), 1e-12);
  ASSERT_EQ(table.history_names.size(), table.rows[0].history.size());
  EXPECT_EQ(table.history_names.front(), "elastic_left_xx [-]");
  EXPECT_EQ(table.history_names.back(), "opened_volume [-]");
}

TEST(PointPath, AStepTooLongToBeSolvedIsCutIntoParts)
{
  // Extension of stiff sand by five times its cell pressure over stiffness in one step: Newton's first trial states are all open.
  const DruckerPrager law = soil(ConeMatch::outer, 30, 5e3);
  const Real strain = 5 * p0 / *law.youngs_modulus;
  const PointPath path{.steps = 1, .controls = {.xx = stress(-p0), .yy = stress(-p0), .zz = rate(strain)}};
  const auto row = drive_one(law, path, -p0 * Mat3::Identity()).rows.back();
  EXPECT_NEAR(row.q / (root3 * (law.cone(0).k + law.cone(0).q * p0) / (1 + law.cone(0).q / root3)), 1, 1e-9);
  EXPECT_NEAR(std::log(row.F(2, 2)) / strain, 1, 1e-3);  // rounding of F - I = 5e-12
}

TEST(PointPath, SaysWhereAStressCannotBeReached)
{
  PointPath path{.steps = 10, .controls = {.xx = stress(1e6), .yy = stress(1e6), .zz = stress(1e6)}};
  path.where = {.file = "drive.yaml", .line = 7, .column = 3, .path = "path"};
  try {
    drive_one(testing::soft_soil(ConeMatch::outer, 30, 0), path);
    FAIL() << "cohesionless soil bears no tension";
  } catch (const RunError& error) {
    EXPECT_NE(std::string(error.what()).find("drive.yaml:7:3: path 1, step 1 of 10, t = 0.1 s: stress "), std::string::npos)
        << error.what();
  }
}

TEST(PointPath, RefusesAStartFromStressWhereTheLawHasNone)
{
  EXPECT_THROW(drive_one(sample<NeoHookean>(), {}, -Mat3::Identity()), RunError);
  EXPECT_THROW(drive(make_material(sample<NeoHookean>(), 0, 0, "empty"), {}), RunError);
}

}  // namespace
}  // namespace talus::point_path_test
