#include "core/parallel/parallel_sort.hpp"

#include <gtest/gtest.h>

#include <random>
#include <utility>

namespace talus::parallel_sort_test {
namespace {

std::vector<std::pair<std::uint64_t, Index>> random_items(std::size_t n)
{
  std::mt19937_64 random(7);
  std::vector<std::pair<std::uint64_t, Index>> items;
  for (std::size_t i = 0; i < n; ++i)
    items.emplace_back(random() % (n / 2 + 1), static_cast<Index>(i));
  return items;
}

/// Lengths below and above that from which ranges are merged, and such that do not divide evenly.
TEST(ParallelSort, SortsAnyLengthWithAnyNumberOfThreads)
{
  const int before = threads();
  for (const std::size_t n : {0, 1, 1000, (1 << 15) - 1, 1 << 15, 100003, 300000}) {
    const auto items = random_items(n);
    auto expected = items;
    std::sort(expected.begin(), expected.end());
    for (const int n_threads : {1, 2, 3, 8}) {
      set_threads(n_threads);
      auto sorted = items;
      parallel_sort(sorted);
      EXPECT_TRUE(sorted == expected) << n << " items, " << n_threads << " threads";
    }
  }
  set_threads(before);
}

}  // namespace
}  // namespace talus::parallel_sort_test
