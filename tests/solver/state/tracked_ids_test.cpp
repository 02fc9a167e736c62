// Ids that are tracked, against a search through all.
#include "solver/state/tracked_ids.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace talus::tracked_ids_test {
namespace {

TEST(TrackedIds, OfNothingFindNothing)
{
  EXPECT_TRUE(TrackedIds().empty());
  EXPECT_FALSE(TrackedIds().place(1));
  EXPECT_TRUE(TrackedIds(std::vector<std::int64_t>{}).empty());
}

TEST(TrackedIds, AreNumberedInAscendingOrderWithoutRepetition)
{
  const TrackedIds ids(std::vector<std::int64_t>{70, 3, 3'000'000'000, 3, 8});
  EXPECT_EQ(ids.size(), 4U);
  EXPECT_EQ(ids.place(3), 0U);
  EXPECT_EQ(ids.place(8), 1U);
  EXPECT_EQ(ids.place(70), 2U);
  EXPECT_EQ(ids.place(3'000'000'000), 3U);
  EXPECT_FALSE(ids.place(6));
  EXPECT_FALSE(ids.place(-1));
}

TEST(TrackedIds, AreThoseOfASearchThroughAll)
{
  std::vector<std::int64_t> id(5000);
  std::iota(id.begin(), id.end(), 0);
  std::mt19937_64 random(1);
  std::shuffle(id.begin(), id.end(), random);
  std::vector<std::int64_t> some(id.begin() + 100, id.begin() + 700);
  const TrackedIds ids(some);
  std::sort(some.begin(), some.end());
  for (const std::int64_t one : id) {
    const auto found = std::find(some.begin(), some.end(), one);
    const auto place = ids.place(one);
    ASSERT_EQ(place.has_value(), found != some.end());
    EXPECT_EQ(place.value_or(0), place ? static_cast<std::size_t>(found - some.begin()) : 0);
  }
}

}  // namespace
}  // namespace talus::tracked_ids_test
