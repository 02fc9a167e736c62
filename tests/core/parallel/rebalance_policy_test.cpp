// The rule by which ranks share a run out anew.
#include "core/parallel/rebalance_policy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace talus::move_rule_test {
namespace {

/// A run of so many steps whose shares become uneven by `growth` a step and are even once they have moved.
struct Course {
  Real lost = 0, paid = 0;  // [s]
  std::int64_t moves = 0, looks = 0;
};
Course run(RebalancePolicy rule, std::int64_t steps, Real seconds, Real growth, Real cost)
{
  Course course;
  Real imbalance = 1;
  for (std::int64_t step = 0; step < steps; ++step) {
    if (rule.looks(step)) {
      ++course.looks;
      if (rule.always_moves() || (rule.has_lost_enough(step, seconds, imbalance) && rule.gains(imbalance, 1))) {
        rule.moved(step, cost);
        imbalance = 1;
        ++course.moves;
        course.paid += cost;
      }
    }
    course.lost += seconds * (1 - 1 / imbalance);
    imbalance += growth;
  }
  return course;
}

TEST(RebalancePolicy, MovesAsOftenAsItIsToldTo)
{
  RebalancePolicy rule(5, 100, 1e9);
  EXPECT_TRUE(rule.always_moves());
  EXPECT_FALSE(rule.looks(100));
  EXPECT_FALSE(rule.looks(104));
  EXPECT_TRUE(rule.looks(105));
  rule.moved(105, 1e9);
  EXPECT_FALSE(rule.looks(109));
  EXPECT_TRUE(rule.looks(110));
  rule.abort_run();
  EXPECT_FALSE(rule.looks(1000));
}

TEST(RebalancePolicy, NeverMovesIfToldSo)
{
  const RebalancePolicy rule(0, 0, 0);
  for (const std::int64_t step : {0, 1, 50, 100000})
    EXPECT_FALSE(rule.looks(step));
}

TEST(RebalancePolicy, WaitsUntilMoreIsLostThanAMoveCosts)
{
  RebalancePolicy rule({}, 0, 9);
  EXPECT_FALSE(rule.always_moves());
  EXPECT_FALSE(rule.looks(49));
  EXPECT_TRUE(rule.looks(50));
  EXPECT_FALSE(rule.has_lost_enough(50, 0.1, 2)) << "half of 5 s";
  EXPECT_FALSE(rule.looks(99));
  EXPECT_TRUE(rule.looks(100));
  EXPECT_FALSE(rule.has_lost_enough(100, 0.1, 4)) << "another 3.75 s";
  EXPECT_TRUE(rule.has_lost_enough(150, 0.1, 4)) << "10 s in all";
  EXPECT_TRUE(rule.gains(4, 1.1));
  rule.moved(150, 20);
  EXPECT_FALSE(rule.has_lost_enough(200, 0.5, 4)) << "a move costs more now, and what was lost before is paid for";
}

TEST(RebalancePolicy, LooksLessOftenWhereNothingIsGained)
{
  RebalancePolicy rule({}, 0, 1);
  EXPECT_TRUE(rule.has_lost_enough(50, 1, 3));
  EXPECT_FALSE(rule.gains(3, 2.9)) << "blocks cannot be cut";
  EXPECT_FALSE(rule.looks(149));
  EXPECT_TRUE(rule.looks(150));
  EXPECT_TRUE(rule.has_lost_enough(150, 1, 3));
  EXPECT_FALSE(rule.gains(3, 2.9));
  EXPECT_FALSE(rule.looks(349));
  EXPECT_TRUE(rule.looks(350));
  rule.moved(350, 1);
  EXPECT_TRUE(rule.looks(400)) << "after a move it begins anew";
}

TEST(RebalancePolicy, OfEvenSharesNothingComes)
{
  const Course course = run(RebalancePolicy({}, 0, 1e-3), 10000, 1, 0, 1e-3);
  EXPECT_EQ(course.moves, 0);
  EXPECT_EQ(course.looks, 199);
}

/// Against every even spacing of moves, the best of which is the best of all here: what is lost grows alike after each move.
TEST(RebalancePolicy, CostsNoMoreThanTwiceTheBest)
{
  constexpr std::int64_t steps = 20000;
  for (const Real cost : {5.0, 50.0, 500.0})
    for (const Real growth : {1e-4, 1e-3}) {
      const Course course = run(RebalancePolicy({}, 0, cost), steps, 0.1, growth, cost);
      Real best = std::numeric_limits<Real>::infinity();
      for (std::int64_t every = 50; every <= 2 * steps; every = every * 11 / 10) {
        const Course other = run(RebalancePolicy(every, 0, cost), steps, 0.1, growth, cost);
        best = std::min(best, other.lost + other.paid);
      }
      EXPECT_LE(course.lost + course.paid, 2 * best + cost) << "a move costs " << cost << " s, growth " << growth;
    }
}

}  // namespace
}  // namespace talus::move_rule_test
