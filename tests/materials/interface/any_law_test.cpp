// What is known of laws without parameters, and copies of parameters.
#include "materials/interface/any_law.hpp"

#include <gtest/gtest.h>

#include <cfenv>

#include "materials/interface/law_variant.hpp"
#include "tests/materials/samples.hpp"

namespace talus::any_law_test {
namespace {

/// Constants of parameters that are zero would be 0/0, which ends a run under floating-point traps.
TEST(KnownLaws, AreDescribedWithoutComputing)
{
  std::feclearexcept(FE_ALL_EXCEPT);
  const auto laws = known_laws();
  EXPECT_EQ(std::fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW), 0);
  ASSERT_EQ(laws.size(), Laws::size);
  EXPECT_EQ(laws.front()->name, LinearElastic::name);
}

TEST(AnyLaw, ACopyThatIsEditedLeavesTheOriginalAlone)
{
  const AnyLaw law(testing::sample<NeoHookean>());
  AnyLaw copy = law;
  std::get<NeoHookean>(choices_of(copy)).density = 1;
  EXPECT_EQ(copy.model()->density(), 1);
  EXPECT_EQ(law.model()->density(), testing::sample<NeoHookean>().density);
}

/// The kind that parameters ask for keeps what they need; the description lists all that the law can keep.
TEST(AnyLaw, IsModelledByTheKindThatItsParametersAskFor)
{
  auto metal = law_example<JohnsonCook>();
  metal.damage.reset();
  metal.mie_gruneisen.reset();
  const AnyLaw law(metal);
  EXPECT_EQ(law.name(), JohnsonCook::name);
  EXPECT_TRUE(law.description().scalar_variable("damage"));
  EXPECT_FALSE(law.model()->description().scalar_variable("damage"));
  EXPECT_LT(law.model()->description().history_width, law.description().history_width);
}

}  // namespace
}  // namespace talus::any_law_test
