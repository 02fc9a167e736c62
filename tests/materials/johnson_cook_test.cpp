// Strength and heating of the law; its kinds, fracture and equation of state have tests of their own.
#include "materials/johnson_cook.hpp"

#include <gtest/gtest.h>

#include "materials/laboratory/point_path.hpp"
#include "tests/materials/metals.hpp"

namespace talus::johnson_cook_test {
namespace {

using testing::copper;
using testing::Dice;
using testing::Point;
using testing::random_step;
using testing::rotation_about;
using testing::steel;
using testing::stiffened;
using testing::stretch;

constexpr Real machine = 1e-12;  // relative: rounding of some hundred operations
constexpr Real MPa = 1e6;

/// The same formula, written once more.
Real expected_strength(const JohnsonCookMetal& m, Real p, Real rate, Real T)
{
  const Real heat = (T - m.room_temperature) / (m.melting_temperature - m.room_temperature);
  const Real softening = heat <= 0 ? 0 : heat >= 1 ? 1 : std::pow(heat, m.thermal_exponent);
  return (m.yield_stress + m.hardening_coefficient * std::pow(p, m.hardening_exponent)) *
         (1 + m.rate_coefficient * std::max(std::log(rate / m.reference_rate), 0.0)) * (1 - softening);
}

/// Rows: rate 1, 1e3, 1e5 1/s.  Columns: plastic strain 0, .05, .1, .5, 1 at 294 K, then at 600 K and 1000 K.
using Table = std::array<std::array<Real, 15>, 3>;
// clang-format off
constexpr Table copper_table{{
  {90.0000, 205.3622, 233.0154, 325.5394, 382.0000, 66.8152, 152.4591, 172.9886, 241.6776, 283.5935,
   32.3281, 73.7664, 83.6995, 116.9343, 137.2150},
  {105.5424, 240.8270, 273.2558, 381.7581, 447.9691, 78.3538, 178.7879, 202.8627, 283.4138, 332.5683,
   37.9110, 86.5055, 98.1539, 137.1281, 160.9112},
  {115.9041, 264.4702, 300.0826, 419.2372, 491.9484, 86.0462, 196.3404, 222.7787, 311.2380, 365.2182,
   41.6329, 94.9981, 107.7902, 150.5907, 176.7087}}};
constexpr Table steel_table{{
  {792.0000, 1026.0466, 1072.2658, 1217.8948, 1302.0000, 637.8503, 826.3437, 863.5671, 980.8518, 1048.5873,
   427.3146, 553.5918, 578.5289, 657.1014, 702.4794},
  {868.5932, 1125.2741, 1175.9631, 1335.6757, 1427.9146, 699.5359, 906.2582, 947.0814, 1075.7086, 1149.9947,
   468.6396, 607.1289, 634.4776, 720.6487, 770.4151},
  {919.6553, 1191.4258, 1245.0947, 1414.1963, 1511.8576, 740.6597, 959.5345, 1002.7577, 1138.9464, 1217.5996,
   496.1896, 642.8203, 671.7767, 763.0136, 815.7056}}};
// clang-format on

TEST(JohnsonCook, FlowStressMatchesTheTableOfBothMetals)
{
  constexpr Real printed = 0.5001e-4;  // half of the last digit
  for (const auto& [law, table] : {std::pair{copper(), copper_table}, {steel(), steel_table}})
    for (std::size_t rate = 0; rate < 3; ++rate)
      for (std::size_t k = 0; k < 15; ++k) {
        const Real p = std::array{0.0, 0.05, 0.1, 0.5, 1.0}[k % 5], T = std::array{294.0, 600.0, 1000.0}[k / 5];
        EXPECT_NEAR(law.flow_stress(p, std::array{1.0, 1e3, 1e5}[rate], T) / MPa, table[rate][k], printed) << p << " " << T;
      }
}

TEST(JohnsonCook, FlowStressHasItsLimits)
{
  const JohnsonCook law = copper();
  EXPECT_EQ(law.flow_stress(0.1, 1e-9, 400), law.flow_stress(0.1, 1, 400));  // slower than the reference
  EXPECT_EQ(law.flow_stress(0.1, 0, 400), law.flow_stress(0.1, 1, 400));
  EXPECT_EQ(law.flow_stress(0.1, 10, 200), law.flow_stress(0.1, 10, 294));  // colder than the room
  EXPECT_EQ(law.flow_stress(0.1, 10, 1356), 0);
  EXPECT_EQ(law.flow_stress(0.1, 10, 5000), 0);
}

/// Strains .05 .1 .2 .5 1 2: temperature [K] and strength [MPa] after adiabatic flow at a constant rate from 294 K,
/// T* F(1, 1/m; 1 + 1/m; T*^m) = K (A e + B e^(n+1) / (n+1)) with K = chi (1 + C ln rate) / (rho c (T_melt - T_room)).
struct Heating {
  JohnsonCook law;
  Real rate;
  std::array<Real, 6> temperature, strength;
};
const std::array<Real, 6> strains{0.05, 0.1, 0.2, 0.5, 1, 2};
std::vector<Heating> heatings()
{
  return {{copper(),
           1e3,
           {296.7362, 300.1150, 307.8025, 334.9156, 386.9547, 500.6345},
           {240.4642, 272.2666, 310.7021, 370.7864, 416.4780, 441.0466}},
          {copper(),
           1e5,
           {297.0046, 300.7141, 309.1507, 338.8656, 395.7040, 518.8623},
           {264.0289, 298.8799, 340.8816, 405.9152, 453.8030, 474.9119}},
          {steel(),
           1e3,
           {306.8722, 320.6006, 349.0180, 436.6880, 580.9204, 842.0727},
           {1116.8964, 1157.4724, 1195.5571, 1217.1959, 1167.8262, 992.6258}},
          {steel(),
           1e5,
           {307.6259, 322.1510, 352.1940, 444.6648, 596.0345, 867.3334},
           {1182.0202, 1224.3405, 1263.2506, 1281.5222, 1221.5266, 1023.5298}}};
}

/// Adiabatic flow in steps of `strain` up to each of the six strains: f(k, point).
template <class F>
void heat_up(const Heating& heating, Real strain, F&& f)
{
  Point<JohnsonCook> point{.law = stiffened(heating.law)};
  Real reached = 0;
  for (std::size_t k = 0; k < strains.size(); ++k) {
    const auto steps = static_cast<int>(std::lround((strains[k] - reached) / strain));
    for (int n = 0; n < steps; ++n)
      point.step(stretch(strain), false, strain / heating.rate);
    reached = strains[k];
    f(k, point);
  }
}

TEST(JohnsonCook, AdiabaticHeatingMatchesTheExactSolution)
{
  // What the trapezoidal rule misses is in the first step of strain h, h^(n+1) B chi / (rho c) (1 / (n+1) - 1/2) < 5e-5 K; the table has
  // four digits.  The strength falls by less than 2 MPa per kelvin.
  for (const Heating& heating : heatings())
    heat_up(heating, 2e-5, [&](std::size_t k, const Point<JohnsonCook>& point) {
      EXPECT_NEAR(point.state.temperature, heating.temperature[k], 1e-4) << strains[k];
      EXPECT_NEAR(von_mises(point.stress) / MPa, heating.strength[k], 2e-4) << strains[k];
      EXPECT_NEAR(point.state.plastic_strain, strains[k], 1e-7);
    });
}

TEST(JohnsonCook, AdiabaticHeatingIsGoodInModerateSteps)
{
  for (const Heating& heating : heatings())
    heat_up(heating, 1e-3, [&](std::size_t k, const Point<JohnsonCook>& point) {
      EXPECT_NEAR(point.state.temperature / heating.temperature[k], 1, 1e-4) << strains[k];
      EXPECT_NEAR(von_mises(point.stress) / MPa / heating.strength[k], 1, 1e-4) << strains[k];
    });
}

TEST(JohnsonCook, TensionTestReadsTheCauchyStressAtThePlasticRate)
{
  // Half of the specimen in a hot room: 4000 1/s, 696 K.
  JohnsonCook law = copper();
  law.initial_temperature = 696;
  const Control none{Controlled::stress, 0};
  const PointPath pull{.steps = 400, .time = 1e-4, .controls = {.xx = Control{Controlled::strain_rate, 4000}, .yy = none, .zz = none}};
  const auto [names, rows] = drive(make_material(law, 0, 1, "bar"), {&pull, 1});
  ASSERT_EQ(names, (std::vector<std::string>{"elastic_left_xx [-]", "elastic_left_yy [-]", "elastic_left_zz [-]", "elastic_left_xy [-]",
                                             "elastic_left_yz [-]", "elastic_left_xz [-]", "plastic_strain [-]", "plastic_work [J/m^3]",
                                             "temperature [K]"}));
  const Real E = law.moduli().youngs;
  constexpr Real driver = 1e-8;  // relative: it leaves 1e-10 of lateral stress, differences of plastic strain lose two digits
  for (std::size_t n = 1; n < rows.size(); ++n) {
    const Real axial = rows[n].stress(0, 0), strain = std::log(rows[n].F(0, 0)), p = rows[n].history[6], T = rows[n].history[8];
    EXPECT_NEAR(p, std::max(strain - axial * rows[n].F.determinant() / E, 0.0), driver * strain);
    if (p > 0) {
      const Real rate = (p - rows[n - 1].history[6]) / (rows[n].time - rows[n - 1].time);
      EXPECT_NEAR(axial / expected_strength(law, p, rate, T), 1, driver) << n;
    } else {
      EXPECT_LT(axial, expected_strength(law, 0, 0, 696));
    }
  }
  EXPECT_GT(rows.back().history[8], 696);
  EXPECT_GT(rows.back().history[6], 0.3);
}

TEST(JohnsonCook, AHundredThousandRandomStepsEndOnOrInsideTheYieldSurface)
{
  Dice dice(1);
  JohnsonCook law = steel();
  law.mie_gruneisen = testing::steel_shock;
  law.damage = testing::steel_damage;
  const Real G = *law.shear_modulus;
  int flowing = 0, failed = 0, molten = 0;
  for (int n = 0; n < 100000; ++n) {
    Point<JohnsonCook> point{.law = law};
    point.state.plastic_strain = n % 10 ? dice.real(0, 1) : 0;
    point.state.temperature = n % 7 ? dice.real(200, 1850) : 0;
    point.state.damage = n % 3 ? dice.real(0, 1) : 0;
    point.prestress(dice.symmetric(5e8));
    const auto start = point.state;
    const Real dt = std::pow(10.0, dice.real(-10, -2));
    const Mat3 f = random_step(dice), Q = dice.rotation();
    Point<JohnsonCook> turned = point;
    point.step(f, false, dt);
    turned.step(Q * f, false, dt);
    ASSERT_TRUE(point.stress.allFinite() && std::isfinite(point.state.temperature) && std::isfinite(point.state.internal_energy));
    ASSERT_LE((turned.stress - Q * point.stress * Q.transpose()).norm(), 1e-9 * point.stress.norm() + machine * G);
    const auto& s = point.state;
    const Real q = von_mises(point.stress), T0 = start.temperature > 0 ? start.temperature : 294;
    ASSERT_GE(s.plastic_work, 0);
    ASSERT_GE(s.damage, start.damage);
    ASSERT_GE(s.plastic_strain, start.plastic_strain);
    if (s.damage == 1) {
      ++failed;
      ASSERT_LE(q, machine * point.stress.norm());
      ASSERT_LE(point.stress.trace(), 0);
    } else if (T0 >= law.melting_temperature) {
      ++molten;
      ASSERT_LE(q, machine * G);
      ASSERT_LE(s.plastic_work, machine * G);
    } else if (s.plastic_work > 0) {
      // The strain of the step, without the digits that the difference has lost: work is the mean of the strengths at its ends times it.
      const Real slow = expected_strength(law, s.plastic_strain, 0, s.temperature);
      const Real slow_before = expected_strength(law, start.plastic_strain, 0, T0);
      const Real increment = s.plastic_work / (0.5 * (q / slow * slow_before + point.F.determinant() * q));
      ASSERT_NEAR(s.plastic_strain, start.plastic_strain + increment, 1e-9 * s.plastic_strain);
      ASSERT_NEAR(s.temperature, T0 + 0.9 * s.plastic_work / (7830 * 477), machine * s.temperature);
      ASSERT_NEAR(q / expected_strength(law, s.plastic_strain, increment / dt, s.temperature), 1, 1e-10) << n;
      ++flowing;
    } else {
      ASSERT_LE(q, (1 + 1e-10) * expected_strength(law, s.plastic_strain, 0, T0) + machine * G) << n;
    }
  }
  EXPECT_GT(flowing, 20000);
  EXPECT_GT(failed, 1000);
  EXPECT_GT(molten, 1000);
  EXPECT_LT(flowing + failed + molten, 90000);
}

TEST(JohnsonCook, ViolentStepsHeatUpToMeltingAndNoFurther)
{
  // Without strength there is no work: heating ends at the melting temperature however far the step goes.
  Point<JohnsonCook> point{.law = steel()};
  for (int n = 0; n < 30; ++n) {
    point.step(stretch(n % 2 ? -5 : 5));
    ASSERT_LE(point.state.temperature, (1 + machine) * 1793);
  }
  EXPECT_GT(point.state.temperature, 1792);
  point.state.temperature = 1793;  // by conduction
  const Real work = point.state.plastic_work;
  point.step(stretch(5));
  EXPECT_LE(von_mises(point.stress), machine * *point.law.shear_modulus);
  EXPECT_NEAR(point.state.temperature, 1793, machine * 1793);
  EXPECT_NEAR(point.state.plastic_work, work, machine * work);
  EXPECT_GE(point.state.plastic_work, work);
}

TEST(JohnsonCook, QuarterTurnInAnyNumberOfStepsKeepsPrincipalStresses)
{
  JohnsonCook law = steel();
  law.mie_gruneisen = testing::steel_shock;
  const Mat3 start = Vec3(-9e8, -4e8, -5e8).asDiagonal();
  for (const int steps : {1, 10, 100}) {
    Point<JohnsonCook> point{.law = law};
    point.prestress(start);
    for (int n = 0; n < steps; ++n)
      point.step(rotation_about(Vec3::UnitZ(), std::acos(0.0) / steps));
    EXPECT_LE((point.stress - Mat3(Vec3(-4e8, -9e8, -5e8).asDiagonal())).norm(),
              1e-15 * steps * 3e11);  // rounding of f - I times stiffness
  }
}

TEST(JohnsonCook, ElasticSimpleShearToTenDoesNotOscillate)
{
  Point<JohnsonCook> point{.law = steel()};
  Mat3 f = Mat3::Identity();
  f(0, 1) = 0.01;
  for (int n = 0; n < 1000; ++n)
    point.step(f, true);
  const Real G = *point.law.shear_modulus;
  EXPECT_NEAR(point.stress(0, 1), 4 * G * std::asinh(5.0) / std::sqrt(104.0), 1e-9 * G);  // rounding times condition 1e4
}

}  // namespace
}  // namespace talus::johnson_cook_test
