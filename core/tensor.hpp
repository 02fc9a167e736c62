#pragma once
// Functions of small tensors that Eigen does not have: packing, deviators, Lame constants, embedding of plane tensors.
#include <cmath>

#include "core/types.hpp"

namespace talus {

template <class E>
Sym3Of<typename E::Scalar> pack(const Eigen::MatrixBase<E>& expression) noexcept
{
  const Mat3Of<typename E::Scalar>& a = expression.derived();
  Sym3Of<typename E::Scalar> s;
  s << a(0, 0), a(1, 1), a(2, 2), a(0, 1), a(1, 2), a(0, 2);
  return s;
}
template <class E>
[[gnu::always_inline]] inline Mat3Of<typename E::Scalar> unpack(const Eigen::MatrixBase<E>& expression) noexcept
{
  const Sym3Of<typename E::Scalar>& s = expression.derived();
  Mat3Of<typename E::Scalar> a;
  a << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
  return a;
}

template <class E>
Mat3Of<typename E::Scalar> sym(const Eigen::MatrixBase<E>& expression) noexcept
{
  const Mat3Of<typename E::Scalar>& a = expression.derived();
  return 0.5 * (a + a.transpose());
}
inline Mat3 skew(const Mat3& a) noexcept { return 0.5 * (a - a.transpose()); }
template <class E>
Mat3Of<typename E::Scalar> dev(const Eigen::MatrixBase<E>& expression) noexcept
{
  using T = typename E::Scalar;
  const Mat3Of<T>& a = expression.derived();
  return a - T(a.trace() / 3) * Mat3Of<T>::Identity();
}

/// J2 = s:s/2 with the deviator s of a; sqrt(J2) is the shear stress tau of the Drucker-Prager law.
template <class E>
typename E::Scalar second_invariant(const Eigen::MatrixBase<E>& a) noexcept
{
  return 0.5 * dev(a).cwiseAbs2().sum();
}
template <class E>
typename E::Scalar von_mises(const Eigen::MatrixBase<E>& a) noexcept
{
  using std::sqrt;
  using T = typename E::Scalar;
  return sqrt(T(3 * second_invariant(a)));
}

/// A plane tensor in 3-D, with zeros out of plane (plane strain for a velocity gradient).  D is the size of `a`.
template <class T, int D>
Mat3Of<T> embed(const Eigen::Matrix<T, D, D, Eigen::DontAlign>& a) noexcept
{
  if constexpr (D == 3) {
    return a;
  } else {
    Mat3Of<T> b = Mat3Of<T>::Zero();
    b.template topLeftCorner<D, D>() = a;
    return b;
  }
}

struct Lame {
  Real lambda, mu;  ///< Pa
};
/// The Lame constants from Young's modulus [Pa] and Poisson's ratio in (-1, 0.5).
constexpr Lame lame(Real youngs_modulus, Real poisson_ratio) noexcept
{
  return {youngs_modulus * poisson_ratio / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio)), youngs_modulus / (2 * (1 + poisson_ratio))};
}

/// s a + m I.  Entry by entry: Eigen would store these six numbers and load them again as one vector, which stalls.
// Inlined explicitly, like others below: instantiations for SimdReal are long enough to become calls, which would pass tensors through
// memory.
template <class E>
[[gnu::always_inline]] inline Sym3Of<typename E::Scalar> scale_and_shift(const typename E::Scalar& s,
                                                                         const Eigen::MatrixBase<E>& expression,
                                                                         const typename E::Scalar& m) noexcept
{
  const Sym3Of<typename E::Scalar>& a = expression.derived();
  Sym3Of<typename E::Scalar> sum;
  sum << s * a[0] + m, s * a[1] + m, s * a[2] + m, s * a[3], s * a[4], s * a[5];
  return sum;
}
template <class E>
Sym3Of<typename E::Scalar> add_diagonal(const Eigen::MatrixBase<E>& a, const typename E::Scalar& m) noexcept
{
  return scale_and_shift(1, a, m);
}

}  // namespace talus
