#pragma once
// Arithmetic on packs (core/simd.hpp) for the loops over a stencil; results are bitwise identical on every processor.
#include <cmath>

#include "core/simd.hpp"

namespace talus {

inline Pack square_root(const Pack& a) noexcept { return Pack{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])}; }
inline Pack broadcast(Real a) noexcept { return Pack{a, a, a, a}; }
/// min(a, b), and b where a is NaN.
inline Pack smaller(const Pack& a, Real b) noexcept { return a < broadcast(b) ? a : broadcast(b); }

/// The pack {sum of a, sum of b, sum of c, sum of d}.
inline Pack sums(const Pack& a, const Pack& b, const Pack& c, const Pack& d) noexcept
{
  const Pack ab = __builtin_shufflevector(a, b, 0, 4, 2, 6) + __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Pack cd = __builtin_shufflevector(c, d, 0, 4, 2, 6) + __builtin_shufflevector(c, d, 1, 5, 3, 7);
  return __builtin_shufflevector(ab, cd, 0, 1, 4, 5) + __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
}

static_assert(pack_size == 4);

}  // namespace talus
