// Rows of the particles that are followed, against a search through all.
#include "solver/state/tracked_particles.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace talus::followed_rows_test {
namespace {

TEST(FollowedRows, OfNobodyHoldNothing)
{
  FollowedRows rows;
  EXPECT_TRUE(rows.empty());
  rows.find(std::vector<std::int64_t>{0, 1, 2});
  EXPECT_EQ(rows.row(1), none);
  EXPECT_TRUE(FollowedRows(std::vector<std::int64_t>{}).empty());
}

TEST(FollowedRows, FindThoseThatAreHere)
{
  FollowedRows rows(std::vector<std::int64_t>{70, 3, 3'000'000'000, 3, 8});
  EXPECT_FALSE(rows.empty());
  EXPECT_EQ(rows.row(3), none) << "nobody has looked yet";
  rows.find(std::vector<std::int64_t>{8, 6, 3'000'000'000, 3});
  EXPECT_EQ(rows.row(3), 3);
  EXPECT_EQ(rows.row(8), 0);
  EXPECT_EQ(rows.row(3'000'000'000), 2);
  EXPECT_EQ(rows.row(70), none) << "followed, but not here";
  EXPECT_EQ(rows.row(6), none) << "here, but not followed";
  EXPECT_EQ(rows.row(-1), none);
  rows.find(std::vector<std::int64_t>{3});
  EXPECT_EQ(rows.row(3), 0);
  EXPECT_EQ(rows.row(8), none) << "it has gone";
}

TEST(FollowedRows, AreThoseOfASearchThroughAll)
{
  std::vector<std::int64_t> id(5000);
  std::iota(id.begin(), id.end(), 0);
  std::mt19937_64 random(1);
  std::shuffle(id.begin(), id.end(), random);
  const std::vector<std::int64_t> followed(id.begin() + 100, id.begin() + 700);
  FollowedRows rows(followed);
  rows.find(std::span(id).first(400));
  for (std::size_t row = 100; row < 700; ++row)
    EXPECT_EQ(rows.row(id[row]), row < 400 ? static_cast<Index>(row) : none);
}

}  // namespace
}  // namespace talus::followed_rows_test
