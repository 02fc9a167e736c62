// Fracture by damage that is averaged over a length: what the particle follows, and which numbers the solver averages.
#include <gtest/gtest.h>

#include "materials/interface/law_variant.hpp"
#include "materials/laboratory/point_path.hpp"
#include "tests/materials/metals.hpp"

namespace talus::johnson_cook_length_test {
namespace {

using testing::Point;
using testing::stretch;

using Averaged = JohnsonCookOf<DamageKept::averaged, false>;
using Local = JohnsonCookOf<DamageKept::local, false>;

constexpr Real fracture = 0.05;  // plastic strain, whatever the stress

JohnsonCook brittle_copper()
{
  JohnsonCook law = testing::copper();
  law.damage = JohnsonCookDamage{.d1 = fracture, .d2 = 0, .d3 = 0, .d4 = 0, .d5 = 0, .softening_length = 2e-3};
  return law;
}

/// Own flow alone neither fails the particle nor is it bounded; the stress is that of metal without damage.
TEST(JohnsonCookLength, OwnFlowDoesNotFail)
{
  JohnsonCook tough = brittle_copper();
  tough.damage.reset();
  Point<Averaged> point{.law = {brittle_copper()}};
  Point<JohnsonCook> whole{.law = tough};
  for (int n = 0; n < 30; ++n)
    point.step(stretch(0.01)), whole.step(stretch(0.01));
  EXPECT_EQ(point.state.damage, 0);
  EXPECT_EQ((point.stress - whole.stress).norm(), 0);
  EXPECT_GT(point.state.local_damage, 4);
  EXPECT_NEAR(point.state.local_damage, point.state.plastic_strain / fracture, 1e-12);
}

/// The mean decides; what it has broken does not heal, nor flow, and its own damage stays.
TEST(JohnsonCookLength, FailsWhereTheMeanIsOneAndStaysSo)
{
  Point<Averaged> point{.law = {brittle_copper()}};
  for (int n = 0; n < 10; ++n)
    point.step(stretch(0.01));
  point.state.mean_damage = 0.9;
  point.step(stretch(0.01));
  EXPECT_EQ(point.state.damage, 0.9);
  EXPECT_GT(von_mises(point.stress), 1e8);
  point.state.mean_damage = 0.8;
  point.step(stretch(0.01));
  EXPECT_EQ(point.state.damage, 0.9);
  point.state.mean_damage = 1.2;
  const Real work = point.state.plastic_work, strain = point.state.plastic_strain;
  Point<JohnsonCook> whole{.law = brittle_copper(), .F = point.F, .stress = point.stress};
  whole.law.damage.reset();
  whole.state.elastic_left = point.state.elastic_left;
  whole.state.plastic_strain = strain, whole.state.plastic_work = work, whole.state.temperature = point.state.temperature;
  point.step(stretch(0.01)), whole.step(stretch(0.01));
  EXPECT_EQ(point.state.damage, 1);
  EXPECT_LE(von_mises(point.stress), 1);
  const Real J = point.F.determinant(), freed = std::pow(J * von_mises(whole.stress), 2) / (6 * *whole.law.shear_modulus);
  EXPECT_NEAR((point.state.plastic_work - whole.state.plastic_work) / freed, 1, 1e-6);  // the elastic energy, as without a length
  const Real damage = point.state.local_damage;
  point.state.mean_damage = 0.5;
  point.step(stretch(0.01));
  EXPECT_EQ(point.state.damage, 1);
  EXPECT_EQ(point.state.local_damage, damage);
  EXPECT_LE(von_mises(point.stress), 1);
  EXPECT_EQ(point.law.yield(point.stress, point.state), von_mises(point.stress));
}

/// Where all flows evenly, the mean is the damage itself, and it fails where it fails without a length.
TEST(JohnsonCookLength, DoesNotMatterWhereAllFlowsEvenly)
{
  Point<Averaged> averaged{.law = {brittle_copper()}};
  Point<Local> local{.law = {brittle_copper()}};
  int steps = 0;
  while (local.state.damage < 1 && ++steps < 1000)
    local.step(stretch(1e-3));
  ASSERT_LT(steps, 1000);
  for (int n = 0; n < steps; ++n) {
    EXPECT_LT(averaged.state.damage, 1);
    averaged.step(stretch(1e-3));
    averaged.state.mean_damage = averaged.state.local_damage;
  }
  averaged.step(stretch(1e-3));
  EXPECT_EQ(averaged.state.damage, 1);

  // The laboratory, too, takes its one point for a body that deforms evenly.
  const Control none{Controlled::stress, 0};
  const PointPath pull{.steps = 100, .controls = {.xx = Control{Controlled::strain_rate, 0.04}, .yy = none, .zz = none}};
  const auto [names, rows] = drive(make_material(brittle_copper(), 0, 1, "bar"), {&pull, 1});
  ASSERT_EQ(names[names.size() - 4], "damage [-]");
  const auto& end = rows.back().history;
  EXPECT_GT(end[end.size() - 4], 0.7);
  EXPECT_NEAR(end[end.size() - 4], end[end.size() - 3], 0.02);  // one step later
}

/// Lanes of which one fails in this step, one has failed, one flows and one is whole.
TEST(JohnsonCookLength, LanesFailEachByItsOwnMean)
{
  const Averaged law{brittle_copper()};
  const auto constants = law.constants();
  std::array<Point<Averaged>, pack_size> alone{Point<Averaged>{law}, Point<Averaged>{law}, Point<Averaged>{law}, Point<Averaged>{law}};
  std::array<Real, numbers_of_state<Averaged::State> * pack_size> history{};
  StateLanes<Averaged::State> states{history.data(), pack_size, pack_size};
  alone[1].state.damage = 1;
  alone[0].state.mean_damage = 1.1, alone[2].state.mean_damage = 0.3;
  alone[2].state.local_damage = 0.7;
  Mat3Of<SimdReal> F, L, stress = Mat3Of<SimdReal>::Zero();
  for (int lane = 0; lane < pack_size; ++lane) {
    const Mat3 f = stretch(lane == 3 ? 1e-5 : 0.02);
    states.set(lane, alone[static_cast<std::size_t>(lane)].state);
    for (Index k = 0; k < 9; ++k)
      F(k).set(lane, f(k)), L(k).set(lane, (f(k) - (k % 4 == 0 ? 1 : 0)) / 1e-3);
  }
  const Mat3Of<SimdReal> after = law.update(IncrementOf<SimdReal>{F, L, stress, 1e-3, 0, false}, states, constants);
  const std::array<Real, pack_size> damage{1, 1, 0.3, 0};
  for (int lane = 0; lane < pack_size; ++lane) {
    auto& point = alone[static_cast<std::size_t>(lane)];
    point.step(stretch(lane == 3 ? 1e-5 : 0.02));
    EXPECT_LE((lane_of(after, lane) - point.stress).norm(), 1e-3) << lane;
    const Averaged::State state = states.of(lane);
    EXPECT_EQ(state.damage, damage[static_cast<std::size_t>(lane)]);
    EXPECT_EQ(state.damage, point.state.damage);
    EXPECT_NEAR(state.local_damage, point.state.local_damage, 1e-11);
  }
  EXPECT_GT(alone[0].state.local_damage, 0.3);  // it flows in the step in which it fails
  EXPECT_EQ(alone[1].state.local_damage, 0);
  EXPECT_GT(alone[2].state.local_damage, 1);
}

TEST(JohnsonCookLength, TellsTheSolverWhatToAverage)
{
  JohnsonCook law = brittle_copper();
  const auto averaging = constitutive_law(law)->strain_averaging();
  ASSERT_TRUE(averaging);
  EXPECT_EQ(averaging->length, 2e-3);
  EXPECT_EQ(averaging->band, 4e-3);
  EXPECT_EQ(averaging->largest, HUGE_VAL);
  for (const bool shocked : {false, true}) {
    if (shocked)
      law.mie_gruneisen = testing::copper_shock;
    const auto model = constitutive_law(law);
    const auto numbers = model->strain_averaging();
    ASSERT_TRUE(numbers);
    EXPECT_EQ(numbers->strain, model->description().scalar_variable("local_damage"));
    EXPECT_EQ(numbers->mean, model->description().scalar_variable("mean_damage"));
    EXPECT_EQ(numbers->rate, model->description().scalar_variable("mean_damage_rate"));
  }
  EXPECT_EQ(AnyLaw(law).description().history_width, constitutive_law(law)->description().history_width);
  law.damage->softening_length.reset();
  EXPECT_FALSE(constitutive_law(law)->strain_averaging());
}

}  // namespace
}  // namespace talus::johnson_cook_length_test
