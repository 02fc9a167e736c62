#pragma once
// Packs of numbers: sums over a stencil run over whole packs, so that they use the vector unit and need no scalar tail.
#include <cstring>

#include "core/types.hpp"

namespace talus {

/// Numbers per pack.  Stencils are padded to whole packs with zero weights.
inline constexpr int pack_size = 4;
constexpr int padded(int n) noexcept { return (n + pack_size - 1) / pack_size * pack_size; }

using Pack = Real __attribute__((vector_size(pack_size * sizeof(Real))));

/// From an address that is a multiple of the pack's size.
inline Pack load(const Real* from) noexcept { return *reinterpret_cast<const Pack*>(__builtin_assume_aligned(from, sizeof(Pack))); }
inline void store(Real* to, const Pack& pack) noexcept { *reinterpret_cast<Pack*>(__builtin_assume_aligned(to, sizeof(Pack))) = pack; }
inline Real sum(const Pack& a) noexcept { return (a[0] + a[1]) + (a[2] + a[3]); }

}  // namespace talus
