#pragma once
// The parallelogram or parallelepiped that a particle covers, by which particles are split (solver/particles/resample.hpp).
#include "solver/strips/strip.hpp"

namespace talus {

/// Deforms the edges of the first n particles, the columns of their matrices [m], with their motion: R <- (I + dt L) R.
template <int D>
void deform_domains(const StripColumns<D>& columns, std::size_t n, Real dt) noexcept
{
  columns.domain.pad(n), columns.L.pad(n);
  for (std::size_t i = 0; i < n; i += pack_size) {
    const MatOf<D> L = columns.L.load(i), R = columns.domain.load(i);
    columns.domain.store(i, R + SimdReal(dt) * L.lazyProduct(R));
  }
}

}  // namespace talus
