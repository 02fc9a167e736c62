#pragma once
// Sorting with several threads.
#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/parallel/threads.hpp"

namespace talus {

/// Sorts in ascending order.  Equal items must be identical, so that the result does not depend on the number of threads.
template <class T>
void parallel_sort(std::vector<T>& items)
{
  constexpr std::size_t least_items = 1 << 14;  // a shorter range is sorted faster than threads begin
  std::size_t ranges = 1;
  while (ranges < static_cast<std::size_t>(threads()) && items.size() / (2 * ranges) >= least_items)
    ranges *= 2;
  const auto at = [&](std::size_t range) { return items.begin() + static_cast<std::ptrdiff_t>(items.size() * range / ranges); };
  parallel_for(static_cast<Index>(ranges), [&](Index i) {
    const auto range = static_cast<std::size_t>(i);
    std::sort(at(range), at(range + 1));
  });
  for (std::size_t width = 1; width < ranges; width *= 2)
    parallel_for(static_cast<Index>(ranges / (2 * width)), [&](Index i) {
      const auto first = 2 * width * static_cast<std::size_t>(i);
      std::inplace_merge(at(first), at(first + width), at(first + 2 * width));
    });
}

}  // namespace talus
