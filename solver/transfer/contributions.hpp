#pragma once
// What particles add to the vertices of their cell.
#include "kernels/pack.hpp"
#include "kernels/symmetric.hpp"
#include "solver/transfer/cell_moments.hpp"

namespace talus {

/// What a particle adds to each vertex of its cell, times the barycentric coordinate, in this order: momentum, m A if `affine`, mass,
/// V sigma, or all of V sigma G^-T if `pulled` back (reference.hpp), forces of loads if `loaded`, then for CellMoments, if `moments`, m v and
/// m B_j B_k.
template <int D, bool affine, bool loaded, bool moments, bool pulled>
struct Contribution {
  static constexpr int field = D, mass = field + (affine ? D * D : 0), tension = mass + 1,
                       load = tension + (pulled ? D * D : Symmetric<D>::size), momentum = load + (loaded ? D : 0), products = momentum + D,
                       size = moments ? products + CellMoments<D>::products : momentum, padded_size = padded(size);
  /// The tension among the numbers of a particle, or of a sum.
  static Mat<D> tension_in(const Real* numbers) noexcept
  {
    Mat<D> all;
    for (int i = 0; i < D; ++i)
      for (int j = 0; j < D; ++j)
        all(i, j) = numbers[tension + (pulled ? j * D + i : Symmetric<D>::place(i, j))];
    return all;
  }
};
/// Sums over the particles of a cell of their contributions to each vertex.
template <int D, class Of>
struct CornerSums {
  alignas(64) Real of[D + 1][Of::padded_size];
};

/// to[i] += from[i] for n numbers at any addresses.
template <int n>
[[gnu::always_inline]] inline void add_numbers(const Real* from, Real* to) noexcept
{
  int i = 0;
  for (; i + pack_size <= n; i += pack_size)
    store_loose(to + i, load_loose(to + i) + load_loose(from + i));
  for (; i < n; ++i)
    to[i] += from[i];
}

}  // namespace talus
