// The message of a stage that did not come to rest: the condition that was not met.
#include <gmock/gmock.h>

#include "solver/stages.hpp"

namespace talus::rest_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

TEST(Rest, NamesTheConditionThatFailed)
{
  const RestConditions motion{.asked = 1e-3, .unbalanced = 2e-4, .kinetic = 0.3, .work = 10, .ramp_over = true};
  EXPECT_FALSE(motion.met());
  EXPECT_THAT(why_not_at_rest(motion, 0, 20), AllOf(StartsWith("kinetic energy 0.03 of the work done, asked 0.001"),
                                                    HasSubstr("unbalanced force 0.0002 of the loads: that is reached")));

  const RestConditions force{.asked = 1e-3, .unbalanced = 0.2, .kinetic = 0.003, .work = 10, .ramp_over = true};
  EXPECT_FALSE(force.met());
  EXPECT_THAT(why_not_at_rest(force, 0, 20), AllOf(StartsWith("unbalanced force 0.2 of the loads, asked 0.001"),
                                                   HasSubstr("kinetic energy 0.0003 of the work done: that is reached")));

  const RestConditions both{.asked = 1e-3, .unbalanced = 0.2, .kinetic = 0.3, .work = 10, .ramp_over = true};
  EXPECT_FALSE(both.met());
  EXPECT_THAT(why_not_at_rest(both, 0, 20), AllOf(HasSubstr("asked 0.001 of both"), Not(HasSubstr("reached"))));
}

TEST(Rest, SaysThatItWasNotHeldOrThatLoadsWereGrowing)
{
  const RestConditions late{.asked = 1e-3, .unbalanced = 2e-4, .kinetic = 0.003, .work = 10, .ramp_over = true};
  EXPECT_TRUE(late.met());
  EXPECT_THAT(why_not_at_rest(late, 7, 20), HasSubstr("only in the last 7 steps, asked are 20 in a row"));
  const RestConditions early{.asked = 1e-3, .unbalanced = 2e-4, .kinetic = 0.003, .work = 10, .ramp_over = false};
  EXPECT_FALSE(early.met());
  EXPECT_THAT(why_not_at_rest(early, 0, 20), HasSubstr("still growing"));
}

TEST(Rest, NothingThatMovesWithoutWorkIsAtRest)
{
  const RestConditions still{.asked = 1e-3, .unbalanced = 0, .kinetic = 0, .work = 0, .ramp_over = true};
  EXPECT_TRUE(still.met());
  const RestConditions moves{.asked = 1e-3, .unbalanced = 0, .kinetic = 2, .work = 0, .ramp_over = true};
  EXPECT_FALSE(moves.met());
  EXPECT_THAT(why_not_at_rest(moves, 0, 20), HasSubstr("kinetic energy 2 J and no work done"));
  const RestConditions trembles{.asked = 1e-3, .unbalanced = 1e-16, .kinetic = 1e-30, .work = 1e-29, .ramp_over = true, .round_off = 1e-20};
  EXPECT_TRUE(trembles.met()) << "what was in balance from the beginning";
}

}  // namespace
}  // namespace talus::rest_test
