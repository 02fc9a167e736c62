#pragma once
// All use of threads.  Sums run over fixed blocks in a fixed order, so results are bitwise independent of the number of threads.
#include <omp.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/types.hpp"

namespace talus {

inline void set_threads(int n) { omp_set_num_threads(n); }
inline int threads() { return omp_get_max_threads(); }

/// Calls f(i) for i in [0, n), divided statically among threads.  f must not throw and must not write data that another i reads.
template <class F>
void parallel_for(Index n, F&& f)
{
#pragma omp parallel for schedule(static)
  for (Index i = 0; i < n; ++i)
    f(i);
}

/// Calls f(i) for i in [0, n) of very unequal cost, divided dynamically among threads.
template <class F>
void parallel_for_uneven(Index n, F&& f)
{
#pragma omp parallel for schedule(dynamic, 1)
  for (Index i = 0; i < n; ++i)
    f(i);
}

/// Items per block of a deterministic reduction.
inline constexpr Index sum_block = 4096;

/// The sum of f(i) over [0, n): within blocks of 4096 in order, then over the blocks in order.  T needs T{} = 0 and +=.  The buffer is
/// kept, so repeated sums of the same length allocate nothing.  Calls must not be nested.
template <class T, class F>
T parallel_sum(Index n, F&& f)
{
  const Index blocks = (n + sum_block - 1) / sum_block;
  static thread_local std::vector<T> buffer;
  buffer.assign(static_cast<std::size_t>(blocks), T{});
  std::vector<T>& partial = buffer;  // a name that the threads below can share
  parallel_for(blocks, [&](Index b) {
    T sum{};
    const Index last = std::min(n, (b + 1) * sum_block);
    for (Index i = b * sum_block; i < last; ++i)
      sum += f(i);
    partial[static_cast<std::size_t>(b)] = sum;
  });
  T total{};
  for (const T& part : partial)
    total += part;
  return total;
}

/// The smallest f(i) over [0, n), or `start` if that is smaller.
template <class F>
Real parallel_min(Index n, Real start, F&& f)
{
  Real least = start;
#pragma omp parallel for schedule(static) reduction(min : least)
  for (Index i = 0; i < n; ++i)
    least = std::min(least, static_cast<Real>(f(i)));
  return least;
}

}  // namespace talus
