#pragma once
// Symmetric D x D matrices in scalars: their adjugates without a detour through memory.
#include "core/types.hpp"

namespace talus {

/// Entries xx, yy, xy or xx, yy, zz, xy, yz, xz.
template <int D>
struct Symmetric {
  static constexpr int size = D * (D + 1) / 2;
  Real entry[size];

  static constexpr int place(int d, int e) noexcept { return d == e ? d : D == 2 ? 2 : d + e == 1 ? 3 : d + e == 3 ? 4 : 5; }
  constexpr Real operator()(int d, int e) const noexcept { return entry[place(d, e)]; }
  constexpr Real trace() const noexcept { return D == 2 ? entry[0] + entry[1] : entry[0] + entry[1] + entry[2]; }
};

/// det(A) A^-1
template <int D>
constexpr Symmetric<D> adjugate(const Symmetric<D>& s) noexcept
{
  if constexpr (D == 2) {
    return {s.entry[1], s.entry[0], -s.entry[2]};
  } else {
    const auto [xx, yy, zz, xy, yz, xz] = s.entry;
    return {yy * zz - yz * yz, xx * zz - xz * xz, xx * yy - xy * xy, xz * yz - xy * zz, xy * xz - xx * yz, xy * yz - xz * yy};
  }
}

/// det(A), from A and its adjugate.
template <int D>
constexpr Real determinant(const Symmetric<D>& s, const Symmetric<D>& adjugate_of_s) noexcept
{
  Real det = 0;
  for (int d = 0; d < D; ++d)
    det += s(0, d) * adjugate_of_s(0, d);
  return det;
}

/// (tr A / D)^D: det A of a round A with the same trace.
template <int D>
constexpr Real round_determinant(const Symmetric<D>& s) noexcept
{
  const Real mean = s.trace() * (1.0 / D);
  return D == 2 ? mean * mean : mean * mean * mean;
}

}  // namespace talus
