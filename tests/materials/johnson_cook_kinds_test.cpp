// Which history the law keeps, and what it refuses.
#include <gtest/gtest.h>

#include "tests/materials/metals.hpp"

namespace talus::johnson_cook_kinds_test {
namespace {

using testing::copper;
using testing::Dice;
using testing::Point;
using testing::steel;
using testing::stretch;

TEST(JohnsonCook, StartsAtItsInitialTemperature)
{
  JohnsonCook law = copper();
  EXPECT_EQ(law.initial_state().temperature, 294);
  law.initial_temperature = 500;
  EXPECT_EQ(law.initial_state().temperature, 500);
  Point<JohnsonCook> unset{.law = law}, set{.law = law, .state = law.initial_state()};
  unset.step(stretch(0.01));
  set.step(stretch(0.01));
  EXPECT_EQ((unset.stress - set.stress).norm(), 0);
  EXPECT_EQ(unset.state.temperature, set.state.temperature);
  EXPECT_GT(set.state.temperature, 500);
}

TEST(JohnsonCook, ConductsHeatAsFastAsItsDiffusivitySays)
{
  JohnsonCook law = copper();
  EXPECT_EQ(law.diffusivity(law.constants()), 0);
  law.conductivity = 386;
  EXPECT_NEAR(law.diffusivity(law.constants()), 1.1248e-4, 0.51e-8);  // 386 / (8960 x 383)
}

template <class State>
std::vector<std::string_view> history_of()
{
  std::vector<std::string_view> keys;
  for_each_field<State>([&](const auto& variable) { keys.push_back(variable.key); });
  return keys;
}

TEST(JohnsonCookKinds, KeepOnlyTheHistoryThatIsAskedFor)
{
  using Keys = std::vector<std::string_view>;
  const Keys common{"elastic_left", "plastic_strain", "plastic_work", "temperature"};
  for (const DamageKept damage : {DamageKept::no, DamageKept::local, DamageKept::averaged})
    for (const bool energy : {false, true}) {
      JohnsonCook law = copper();
      Keys expected = common;
      if (damage != DamageKept::no)
        law.damage = testing::copper_damage, expected.emplace_back("damage");
      if (damage == DamageKept::averaged) {
        law.damage->softening_length = 1e-3;
        expected.insert(expected.end(), {"local_damage", "mean_damage", "mean_damage_rate"});
      }
      if (energy)
        law.mie_gruneisen = testing::copper_shock, expected.emplace_back("internal_energy");
      std::visit(
          [&]<class Kind>(const Kind& kind) {
            EXPECT_EQ(history_of<typename Kind::State>(), expected);
            EXPECT_EQ(sizeof(typename Kind::State), (expected.size() + 5) * sizeof(Real));  // one of them has six numbers
            EXPECT_EQ(kind.yield_stress, 90e6);
            EXPECT_EQ(kind.damage.has_value(), damage != DamageKept::no);
            EXPECT_EQ(kind.mie_gruneisen.has_value(), energy);
          },
          law.kind());
    }
}

TEST(JohnsonCookKinds, AnswerWithTheSameBitsWhereTheGroupsAreOff)
{
  Dice dice(3);
  const JohnsonCook law = steel();
  Point<JohnsonCook> all{.law = law};
  Point<JohnsonCookOf<DamageKept::no, false>> none{.law = {law}};
  Point<JohnsonCookOf<DamageKept::local, false>> failing{.law = {law}};
  Point<JohnsonCookOf<DamageKept::no, true>> shocked{.law = {law}};
  for (int n = 0; n < 200; ++n) {
    const Mat3 f = Mat3::Identity() + dice.matrix(0.01);
    all.step(f), none.step(f), failing.step(f), shocked.step(f);
    ASSERT_EQ((all.stress - none.stress).norm(), 0);
    ASSERT_EQ((all.stress - failing.stress).norm(), 0);
    ASSERT_EQ((all.stress - shocked.stress).norm(), 0);
    ASSERT_EQ(all.state.temperature, none.state.temperature);
    ASSERT_EQ(all.state.plastic_work, shocked.state.plastic_work);
  }
  EXPECT_GT(all.state.plastic_strain, 0.5);
  EXPECT_EQ(all.state.damage, 0);
  EXPECT_EQ(all.state.internal_energy, 0);
}

TEST(JohnsonCookRules, ContradictionsAreToldInWords)
{
  const auto problems = [](auto change) { return testing::problems_of(copper(), change); };
  using testing::Problems;
  EXPECT_EQ(problems([](auto&) {}), Problems{});
  EXPECT_EQ(problems([](auto& law) { law.melting_temperature = 294; }),
            Problems{"melting_temperature 294 is not above room_temperature 294"});
  EXPECT_EQ(problems([](auto& law) { law.initial_temperature = 1400; }),
            Problems{"initial_temperature 1400 is not below melting_temperature 1356: there would be no strength"});
  EXPECT_EQ(problems([](auto& law) { law.initial_temperature = 1355; }), Problems{});
  EXPECT_EQ(problems([](auto& law) { law.bulk_modulus.reset(), law.poisson_ratio = 0.7; }),
            Problems{"poisson_ratio 0.7 and shear_modulus 4.6e+10 make Poisson's ratio 0.7, which must lie in (-1, 0.5)"});
}

}  // namespace
}  // namespace talus::johnson_cook_kinds_test
