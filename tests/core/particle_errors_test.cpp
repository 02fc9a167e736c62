#include "core/particle_errors.hpp"

#include <gtest/gtest.h>

namespace talus::health_test {
namespace {

TEST(ParticleErrors, TellsTheCauseBeforeWhatFollowsFromIt)
{
  ParticleErrors errors;
  EXPECT_FALSE(errors.worst());
  errors.report(3, Trouble::no_answer);
  errors.report(8, Trouble::inverted);
  errors.report(5, Trouble::inverted);
  ASSERT_TRUE(errors.worst());
  EXPECT_EQ(errors.worst()->id, 5);
  EXPECT_EQ(errors.worst()->trouble, Trouble::inverted);
  errors.clear();
  EXPECT_FALSE(errors.worst());
}

}  // namespace
}  // namespace talus::health_test
