// Recorded motions: samples are joined as they say, and what a baseline takes off is gone at the end.
#include "core/recorded_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace talus::record_test {
namespace {

const std::vector<Real> times{0, 0.5, 0.7, 2};

TEST(Record, IntegratesAPiecewiseLinearAccelerationExactly)
{
  const Record record = record_of_acceleration(times, times);  // a = t, so v = t^2 / 2 and u = t^3 / 6
  for (const Real t : {0.0, 0.2, 0.5, 0.61, 1.3, 2.0})
    EXPECT_NEAR(record(t), t * t / 2, 1e-15) << t;
  EXPECT_NEAR(record.displacement(), 8.0 / 6, 1e-14);
  EXPECT_EQ(record.peak_acceleration(), 2);
  EXPECT_EQ(record(-1), 0);
  EXPECT_EQ(record(5), record(2));
}

TEST(Record, JoinsVelocitiesByStraightLines)
{
  const Record record = record_of_velocity(times, {1, 2, -2, 0});
  EXPECT_EQ(record(-1), 1);
  EXPECT_EQ(record(0.25), 1.5);
  EXPECT_NEAR(record(0.6), 0, 1e-14);
  EXPECT_EQ(record(3), 0);
  EXPECT_NEAR(record.displacement(), 0.75 + 0 - 1.3, 1e-14);
  EXPECT_NEAR(record.peak_acceleration(), 20, 1e-12);
}

TEST(Record, FindsThePeakVelocityBetweenSamples)
{
  EXPECT_NEAR(record_of_acceleration({0, 2}, {1, -1}).peak_velocity(), 0.5, 1e-15);  // t - t^2 / 2 at t = 1
}

TEST(Record, BaselinesLeaveNoVelocityAndNoWayAtTheEnd)
{
  std::vector<Real> t, value;
  for (int k = 0; k <= 200; ++k) {
    t.push_back(0.3 + 0.01 * k + (k % 3 == 0 ? 0.002 : 0.0));
    value.push_back(std::sin(0.11 * k) * std::exp(-0.01 * k) + 0.05);
  }
  for (const Record& record : {record_of_acceleration(t, value), record_of_velocity(t, value)}) {
    EXPECT_GT(std::abs(record.velocity.back()), 0.01);
    const Record still = ends_without_velocity(record), home = ends_where_it_began(record);
    EXPECT_NEAR(still.velocity.back(), 0, 1e-12);
    EXPECT_NEAR(home.velocity.back(), 0, 1e-12);
    EXPECT_NEAR(home.displacement(), 0, 1e-12);
    EXPECT_EQ(still.velocity.front(), record.velocity.front());
    if (!record.acceleration.empty()) {
      const Real off = record.acceleration[0] - still.acceleration[0];
      for (std::size_t k = 0; k < t.size(); ++k)
        EXPECT_NEAR(record.acceleration[k] - still.acceleration[k], off, 1e-12);  // a constant
    }
  }
}

}  // namespace
}  // namespace talus::record_test
