#pragma once
// The only threading code.  Sums go over fixed blocks in fixed order, so the bits do not depend on the number of threads.
#include <omp.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/types.hpp"

namespace talus {

inline void set_threads(int n) { omp_set_num_threads(n); }
inline int threads() { return omp_get_max_threads(); }

/// f(i) for i in [0, n), statically shared out.  f must not throw and must not write what another i reads.
template <class F>
void parallel_for(Index n, F&& f)
{
#pragma omp parallel for schedule(static)
  for (Index i = 0; i < n; ++i)
    f(i);
}

/// The same for items of very unequal cost.
template <class F>
void parallel_for_uneven(Index n, F&& f)
{
#pragma omp parallel for schedule(dynamic, 1)
  for (Index i = 0; i < n; ++i)
    f(i);
}

/// Items per block of a deterministic reduction.
inline constexpr Index sum_block = 4096;

/// Sum of f(i) over [0, n): every block of 4096 in order, then the blocks in order.  T needs T{} = 0 and +=.
/// Its buffer is kept, so a repeated sum of the same length allocates nothing.  Not to be nested.
template <class T, class F>
T parallel_sum(Index n, F&& f)
{
  const Index blocks = (n + sum_block - 1) / sum_block;
  static thread_local std::vector<T> buffer;
  buffer.assign(static_cast<std::size_t>(blocks), T{});
  std::vector<T>& partial = buffer;  // a name that the threads below share
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

/// Smallest f(i) over [0, n), or `start` if that is smaller.
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
