#pragma once
// The affine field that particles give to the nodes: what they have read there, about the positions to which they have moved since.
#include <limits>

#include "solver/strips/strip.hpp"

namespace talus {

/// det(M) M^-1, one per lane.
template <int D>
[[gnu::always_inline]] inline MatOf<D> adjugate_of(const MatOf<D>& M) noexcept
{
  MatOf<D> adjugate;
  if constexpr (D == 2) {
    adjugate(0, 0) = M(1, 1), adjugate(0, 1) = -M(0, 1), adjugate(1, 0) = -M(1, 0), adjugate(1, 1) = M(0, 0);
  } else {
    for (int r = 0; r < D; ++r)
      for (int c = 0; c < D; ++c) {
        const int r1 = (r + 1) % D, r2 = (r + 2) % D, c1 = (c + 1) % D, c2 = (c + 2) % D;
        adjugate(c, r) = M(r1, c1) * M(r2, c2) - M(r1, c2) * M(r2, c1);
      }
  }
  return adjugate;
}

/// The affine field [1/s] of particles i to i + 3, which have moved for a time dt since they read C: C (I + dt C)^-1, the same linear
/// field about their new positions, but never longer than C (Frobenius).  Without the factor a disk of `projected` and `aflip` loses a
/// third of its spin in twenty turns; without the limit it would grow without bound where noise compresses.  For dt = 0, and with
/// references, C is about the right places already.
template <int D>
[[gnu::always_inline]] inline MatOf<D> affine_field(const StripColumns<D>& columns, std::size_t i, Real dt) noexcept
{
  const MatOf<D> C = columns.affine_field().load(i);
  if (columns.G || !(dt > 0))
    return C;
  const MatOf<D> moved = MatOf<D>::Identity() + SimdReal(dt) * C, adjugate = adjugate_of<D>(moved);
  SimdReal det = moved(0, 0) * adjugate(0, 0);
  for (int k = 1; k < D; ++k)
    det += moved(0, k) * adjugate(k, 0);
  MatOf<D> A = C.lazyProduct(adjugate);  // still det times as long
  const SimdReal longer = sqrt(A.squaredNorm() / (C.squaredNorm() + SimdReal(std::numeric_limits<Real>::min())));
  constexpr Real least = std::numeric_limits<Real>::epsilon();  // where neither bounds anything, A is zero to rounding
  const SimdReal factor = SimdReal(1.0) / max(max(det, longer), SimdReal(least));
  for (int k = 0; k < D * D; ++k)
    A(k) *= factor;
  return A;
}

}  // namespace talus
