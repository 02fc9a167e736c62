#pragma once
// Symmetric D x D matrices as scalars in registers, and their adjugates.
#include "core/types.hpp"

namespace talus {

/// The entries xx, yy, xy or xx, yy, zz, xy, yz, xz; T is a number or a pack of numbers.
template <int D, class T = Real>
struct Symmetric {
  static constexpr int size = D * (D + 1) / 2;
  T entry[size];

  static constexpr int place(int d, int e) noexcept { return d == e ? d : D == 2 ? 2 : d + e == 1 ? 3 : d + e == 3 ? 4 : 5; }
  constexpr const T& operator()(int d, int e) const noexcept { return entry[place(d, e)]; }
  constexpr T trace() const noexcept
  {
    T sum = entry[0];
    for (int d = 1; d < D; ++d)
      sum += entry[d];
    return sum;
  }
};

/// The adjugate, det(A) A^-1.
template <int D, class T>
constexpr Symmetric<D, T> adjugate(const Symmetric<D, T>& s) noexcept
{
  if constexpr (D == 2) {
    return {s.entry[1], s.entry[0], -s.entry[2]};
  } else {
    const auto& [xx, yy, zz, xy, yz, xz] = s.entry;
    return {yy * zz - yz * yz, xx * zz - xz * xz, xx * yy - xy * xy, xz * yz - xy * zz, xy * xz - xx * yz, xy * yz - xz * yy};
  }
}

/// The determinant of A, from A and its adjugate.
template <int D, class T>
constexpr T determinant(const Symmetric<D, T>& s, const Symmetric<D, T>& adjugate_of_s) noexcept
{
  T det = s(0, 0) * adjugate_of_s(0, 0);
  for (int d = 1; d < D; ++d)
    det += s(0, d) * adjugate_of_s(0, d);
  return det;
}

/// (tr A / D)^D, the determinant of a multiple of I with the trace of A.
template <int D, class T>
constexpr T round_determinant(const Symmetric<D, T>& s) noexcept
{
  const T mean = s.trace() * (1.0 / D);
  return D == 2 ? mean * mean : mean * mean * mean;
}

}  // namespace talus
