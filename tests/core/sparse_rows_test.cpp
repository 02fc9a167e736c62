#include "core/sparse_rows.hpp"

#include <gtest/gtest.h>

#include "tests/core/resident_pages.hpp"

namespace talus::sparse_rows_test {
namespace {

struct alignas(64) Row {
  double number{};
  float other{};
};

TEST(SparseRows, TakeMemoryWhereTheyAreWritten)
{
  SparseRows<Row> rows;
  rows.resize(100'000);
  const Pages before = pages_of(rows);
  EXPECT_GE(before.all, 64U * 100'000 / 4096);
  EXPECT_EQ(before.resident, 0U);
  for (std::size_t i = 50'000; i < 51'000; ++i)
    rows[i].number = 1;
  const Pages after = pages_of(rows);
  EXPECT_GE(after.resident, 1000U * 64 / 4096);
  EXPECT_LE(after.resident, 1000U * 64 / 4096 + 2);
}

TEST(SparseRows, AreZeroAndInCacheLines)
{
  const SparseRows<Row> rows(1000);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(rows.data()) % alignof(Row), 0U);
  for (const Row& row : rows) {
    EXPECT_EQ(row.number, 0);
    EXPECT_EQ(row.other, 0);
  }
}

TEST(SparseRows, KeepWhatIsThereWhenTheyGrowAndAreCopied)
{
  SparseRows<Row> rows(3);
  rows[2].number = 5;
  rows.push_back({7, 1});
  rows.resize(1000);
  EXPECT_EQ(rows[2].number, 5);
  EXPECT_EQ(rows[3].other, 1);
  EXPECT_EQ(rows[999].number, 0);
  const SparseRows<Row> copy = rows;
  EXPECT_EQ(copy[3].number, 7);
}

TEST(SparseRows, CountTheirBytes)
{
  EXPECT_EQ(bytes_of_all(), 0U);
  EXPECT_EQ(bytes_of_all(SparseRows<Row>(3), std::vector<float>(2)), 3U * 64 + 2 * 4);
}

}  // namespace
}  // namespace talus::sparse_rows_test
