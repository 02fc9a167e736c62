// Words, ranges and errors: the text a user reads.
#include <gtest/gtest.h>

#include <limits>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "core/word_match.hpp"

namespace talus::text_test {
namespace {

const std::vector<std::string> keys{"density", "friction_angle", "dilation_angle", "cohesion"};

TEST(Words, ASlipOfTheHandFindsItsKey)
{
  EXPECT_EQ(closest_match("frition_angle", keys), "friction_angle");
  EXPECT_EQ(closest_match("densiyt", keys), "density");  // neighbours swapped
  EXPECT_EQ(closest_match("cohesion", keys), "cohesion");
  EXPECT_EQ(closest_match("dilatency_angle", keys), "dilation_angle");
}

TEST(Words, AnotherWordFindsNone)
{
  EXPECT_EQ(closest_match("velocity", keys), std::nullopt);
  EXPECT_EQ(closest_match("", keys), std::nullopt);
  EXPECT_EQ(closest_match("density", {}), std::nullopt);
  EXPECT_EQ(closest_match(std::string(5000, 'd'), keys), std::nullopt);
}

TEST(Words, SwappedNeighboursCountAsOneSlip)
{
  const std::vector<std::string> words{"ab"};
  EXPECT_EQ(closest_match("ba", words), "ab");          // one swap
  EXPECT_EQ(closest_match("cd", words), std::nullopt);  // two replacements
}

TEST(Words, SuggestionsReadAsSentences)
{
  EXPECT_EQ(suggestion("desity", keys), " — did you mean \"density\"?");
  EXPECT_EQ(suggestion("velocity", keys), "; known: density, friction_angle, dilation_angle or cohesion");
  EXPECT_EQ(suggestion("velocity", {}), "");
}

TEST(Words, ListsInPlainEnglish)
{
  EXPECT_EQ(or_list({}), "");
  EXPECT_EQ(or_list(std::vector<std::string>{"a"}), "a");
  EXPECT_EQ(or_list(std::vector<std::string>{"a", "b"}), "a or b");
  EXPECT_EQ(or_list(std::vector<std::string>{"a", "b", "c"}), "a, b or c");
}

TEST(Range, HoldsItsEndsOnlyIfAllowed)
{
  EXPECT_FALSE(positive.holds(0));
  EXPECT_TRUE(positive.holds(5e-324));
  EXPECT_TRUE(non_negative.holds(0));
  EXPECT_TRUE(within(-1, 1).holds(1));
  EXPECT_FALSE(between(-1, 1).holds(1));
  EXPECT_TRUE(from_to_below(0, 90).holds(0));
  EXPECT_FALSE(from_to_below(0, 90).holds(90));
  EXPECT_TRUE(at_least(3).holds(3));
}

TEST(Range, NeverHoldsWhatIsNotANumber)
{
  const Real infinity = std::numeric_limits<Real>::infinity(), nan = std::numeric_limits<Real>::quiet_NaN();
  for (const Range& range : {any, positive, non_negative, within(-1, 1), at_least(0)}) {
    EXPECT_FALSE(range.holds(nan)) << to_string(range);
    EXPECT_FALSE(range.holds(infinity)) << to_string(range);
    EXPECT_FALSE(range.holds(-infinity)) << to_string(range);
  }
}

TEST(Range, ReadsAsMathematics)
{
  EXPECT_EQ(to_string(any), "any");
  EXPECT_EQ(to_string(positive), "> 0");
  EXPECT_EQ(to_string(non_negative), ">= 0");
  EXPECT_EQ(to_string(between(-1, 0.5)), "(-1, 0.5)");
  EXPECT_EQ(to_string(within(0, 1)), "[0, 1]");
  EXPECT_EQ(to_string(from_to_below(0, 90)), "[0, 90)");
  EXPECT_EQ(to_string(Range{.high = 2}), "< 2");
  EXPECT_EQ(to_string(Range{.high = 2, .high_allowed = true}), "<= 2");
}

TEST(Where, PrintsWhatIsKnown)
{
  EXPECT_EQ(to_string(SourceLocation{}), "");
  EXPECT_EQ(to_string(SourceLocation{"a.yaml", 0, 0, ""}), "a.yaml");
  EXPECT_EQ(to_string(SourceLocation{"a.yaml", 3, 0, ""}), "a.yaml:3");
  EXPECT_EQ(to_string(SourceLocation{"a.yaml", 3, 9, ""}), "a.yaml:3:9");
}

TEST(SceneErrors, PrintLikeACompilerInOrderOfLines)
{
  const SceneErrors errors({{{"s.yaml", 12, 3, "time.end"}, "must be > 0", "  end: -1"}, {{"s.yaml", 2, 0, ""}, "no key \"mehs\"", ""}});
  EXPECT_STREQ(errors.what(),
               "s.yaml:2: error: no key \"mehs\"\n"
               "s.yaml:12:3: error: time.end: must be > 0\n"
               "   12 |   end: -1\n"
               "      |   ^\n"
               "2 errors, nothing was run.");
  ASSERT_EQ(errors.problems().size(), 2u);
  EXPECT_EQ(errors.problems()[0].where.line, 2);
}

TEST(SceneErrors, OneProblemWithoutAPlace)
{
  const SceneErrors error(SourceLocation{}, "the scene is empty");
  EXPECT_STREQ(error.what(), "error: the scene is empty\n1 error, nothing was run.");
}

}  // namespace
}  // namespace talus::text_test
