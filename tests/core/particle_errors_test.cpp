#include "core/particle_errors.hpp"

#include <gtest/gtest.h>

namespace talus::health_test {
namespace {

TEST(ParticleErrors, TellsTheCauseBeforeWhatFollowsFromIt)
{
  ParticleErrors health;
  EXPECT_FALSE(health.worst());
  health.report(3, Trouble::no_answer);
  health.report(8, Trouble::inverted);
  health.report(5, Trouble::inverted);
  ASSERT_TRUE(health.worst());
  EXPECT_EQ(health.worst()->id, 5);
  EXPECT_EQ(health.worst()->trouble, Trouble::inverted);
  health.clear();
  EXPECT_FALSE(health.worst());
}

}  // namespace
}  // namespace talus::health_test
