#pragma once
// Logarithm and exponential of symmetric 3x3 tensors, fast near the identity, and the rotation of a polar decomposition.  Arguments and
// results are differences from the identity, so that strains of 1e-8 keep all their digits.
#include <Eigen/Eigenvalues>
#include <cmath>

#include "core/simd.hpp"
#include "core/tensor.hpp"

namespace talus {

/// The largest Frobenius norm of the deviator for the series below; beyond it principal axes are computed.
inline constexpr Real series_radius = 0.1;
/// Up to this norm, as in most soil and metal, fewer terms are enough.
inline constexpr Real short_series_radius = 0.01;

template <class E>
typename E::Scalar trace(const Eigen::MatrixBase<E>& a) noexcept
{
  static_assert(E::RowsAtCompileTime == 6);
  return a[0] + a[1] + a[2];
}
/// The double contraction a:a.
template <class E>
typename E::Scalar squared_norm(const Eigen::MatrixBase<E>& expression) noexcept
{
  const Sym3Of<typename E::Scalar>& a = expression.derived();
  return a[0] * a[0] + a[1] * a[1] + a[2] * a[2] + 2 * (a[3] * a[3] + a[4] * a[4] + a[5] * a[5]);
}

/// (I + H)(I + b)(I + H)^T - I: the left Cauchy-Green tensor minus identity after a step with displacement gradient H.
template <class E>
Sym3Of<typename E::Scalar> push_forward(const Eigen::MatrixBase<E>& gradient, const Sym3Of<typename E::Scalar>& b) noexcept
{
  using T = typename E::Scalar;
  const Mat3Of<T>& H = gradient.derived();
  const Mat3Of<T> old = unpack(b);
  const auto half = [&](int i, int j) __attribute__((always_inline))
  {
    return T(old(i, j) + H(i, 0) * old(0, j) + H(i, 1) * old(1, j) + H(i, 2) * old(2, j) + H(i, j));
  };
  const auto entry = [&](int i, int j) __attribute__((always_inline))
  {
    return T(half(i, j) + H(j, i) + half(i, 0) * H(j, 0) + half(i, 1) * H(j, 1) + half(i, 2) * H(j, 2));
  };
  Sym3Of<T> pushed;
  pushed << entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(0, 2);
  return pushed;
}

namespace detail {

/// sum_k c[k] X^(k+1), `terms` of them, of a symmetric trace-free X.  Cayley-Hamilton, X^3 = J2 X + J3 I, keeps every power in the span of
/// I, X, X^2, so that one product of matrices is enough.
template <std::size_t terms, class T, std::size_t N>
[[gnu::always_inline]] inline Sym3Of<T> trace_free_series(const Sym3Of<T>& X, const std::array<Real, N>& c) noexcept
{
  const T xx = X[0], yy = X[1], zz = X[2], xy = X[3], yz = X[4], xz = X[5];
  Sym3Of<T> X2;
  X2 << xx * xx + xy * xy + xz * xz, xy * xy + yy * yy + yz * yz, xz * xz + yz * yz + zz * zz, xy * (xx + yy) + xz * yz,
      xy * xz + yz * (yy + zz), xz * (xx + zz) + xy * yz;
  const T J2 = 0.5 * trace(X2);
  const T J3 = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
  T a = 0, b = 0, d = 0;  // the sum so far is a I + b X + d X^2
  for (std::size_t k = terms; k-- > 0;) {
    const T b_new = a + d * J2 + c[k];
    a = d * J3;
    d = b;
    b = b_new;
  }
  Sym3Of<T> sum;
  sum << b * xx + d * X2[0] + a, b * yy + d * X2[1] + a, b * zz + d * X2[2] + a, b * xy + d * X2[3], b * yz + d * X2[4], b * xz + d * X2[5];
  return sum;
}

// The eigenvalues of a trace-free X are at most sqrt(2/3) |X| <= 0.0817, so the first term left out is below
// 0.0817^14/15 = 4e-17 (logarithm) and 0.0817^9/10! = 5e-17 (exponential) of the first term: less than one rounding.
// Within the short radius 8 and 6 terms leave out 0.00817^8/9 = 2e-18 and 0.00817^6/7! = 6e-17.
inline constexpr std::array<Real, 14> logarithm_series = [] {
  std::array<Real, 14> c{};
  for (std::size_t k = 0; k < c.size(); ++k)
    c[k] = (k % 2 == 0 ? 1.0 : -1.0) / static_cast<Real>(k + 1);
  return c;
}();
inline constexpr std::array<Real, 9> exponential_series = [] {
  std::array<Real, 9> c{};
  Real factorial = 1;
  for (std::size_t k = 0; k < c.size(); ++k) {
    factorial *= static_cast<Real>(k + 1);
    c[k] = 1 / factorial;
  }
  return c;
}();

// What uses principal axes is not inlined: most steps do not need it, and inlined it leaves fewer registers to them.
template <class F>
Sym3 in_principal_axes(const Sym3& A, F&& f) noexcept
{
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(unpack(A));
  const Mat3& V = axes.eigenvectors();
  return pack(V * axes.eigenvalues().unaryExpr(f).asDiagonal() * V.transpose());
}
/// The tensor whose lanes are f of the tensor in each lane.
template <class F>
Sym3Of<SimdReal> tensor_in_each_lane(const Sym3Of<SimdReal>& all, F&& f) noexcept
{
  Sym3Of<SimdReal> result;
  for (int lane = 0; lane < pack_size; ++lane) {
    Sym3 one;
    for (int k = 0; k < 6; ++k)
      one[k] = all[k][lane];
    one = f(one);
    for (int k = 0; k < 6; ++k)
      result[k].set(lane, one[k]);
  }
  return result;
}
template <class T>
[[gnu::noinline]] Sym3Of<T> log1p_by_axes(const Sym3Of<T>& B) noexcept;
template <class T>
[[gnu::noinline]] Sym3Of<T> expm1_by_axes(const Sym3Of<T>& E) noexcept;

}  // namespace detail

/// ln(I + B) for a symmetric B.  NaN where I + B is not positive definite.
template <class Expression>
Sym3Of<typename Expression::Scalar> log1p(const Eigen::MatrixBase<Expression>& expression) noexcept
{
  using std::log1p;
  using T = typename Expression::Scalar;
  const Sym3Of<T>& B = expression.derived();
  const T mean = trace(B) * (1.0 / 3);
  const T scale = 1 / (1 + mean);
  const Sym3Of<T> X = scale_and_shift(scale, B, -mean * scale);
  const T size = squared_norm(X);
  if (!all_of(mean > -1 && size <= series_radius * series_radius))
    return detail::log1p_by_axes<T>(B);
  const T volumetric = log1p(mean);
  if (all_of(size <= short_series_radius * short_series_radius))
    return add_diagonal(detail::trace_free_series<8>(X, detail::logarithm_series), volumetric);
  return add_diagonal(detail::trace_free_series<14>(X, detail::logarithm_series), volumetric);
}

/// exp(E) - I for a symmetric E.
template <class Expression>
Sym3Of<typename Expression::Scalar> expm1(const Eigen::MatrixBase<Expression>& expression) noexcept
{
  using std::expm1;
  using T = typename Expression::Scalar;
  const Sym3Of<T>& E = expression.derived();
  const T mean = trace(E) * (1.0 / 3);
  const Sym3Of<T> X = add_diagonal(E, -mean);
  const T size = squared_norm(X);
  if (!all_of(size <= series_radius * series_radius))
    return detail::expm1_by_axes<T>(E);
  const T volumetric = expm1(mean);
  if (all_of(size <= short_series_radius * short_series_radius))
    return scale_and_shift(1 + volumetric, detail::trace_free_series<6>(X, detail::exponential_series), volumetric);
  return scale_and_shift(1 + volumetric, detail::trace_free_series<9>(X, detail::exponential_series), volumetric);
}

namespace detail {
// If one lane is beyond the radius of the series, each lane is treated separately, as others may be within.
template <class T>
Sym3Of<T> log1p_by_axes(const Sym3Of<T>& B) noexcept
{
  if constexpr (std::is_same_v<T, Real>)
    return in_principal_axes(B, [](Real x) { return std::log1p(x); });
  else
    return tensor_in_each_lane(B, [](const Sym3& one) { return log1p(one); });
}
template <class T>
Sym3Of<T> expm1_by_axes(const Sym3Of<T>& E) noexcept
{
  if constexpr (std::is_same_v<T, Real>)
    return in_principal_axes(E, [](Real x) { return std::expm1(x); });
  else
    return tensor_in_each_lane(E, [](const Sym3& one) { return expm1(one); });
}
}  // namespace detail

/// The rotation R of F = R U, det F > 0.  Newton's iteration with the scaling of Higham, SIAM J. Sci. Stat. Comput. 7 (1986) 1160; it
/// converges quadratically from every regular F, also for equal stretches.  NaN where F is singular.
template <class T>
Mat3Of<T> polar_rotation(const Mat3Of<T>& F) noexcept
{
  using std::abs, std::sqrt;
  constexpr int enough = 30;  // 9 iterations are enough for a condition number of 1e12
  constexpr Real rounding = 1e-15;
  Mat3Of<T> R = F;
  for (int i = 0; i < enough; ++i) {
    const Mat3Of<T> inverse = R.inverse().transpose();
    const T change_of_scale = sqrt(T(inverse.norm() / R.norm()));
    const T scale = where(abs(change_of_scale - 1) < 1e-2, 1, change_of_scale);
    const Mat3Of<T> next = 0.5 * (scale * R + T(1 / scale) * inverse);
    const T change = (next - R).squaredNorm();
    R = next;
    if (!any_of(change > 3 * rounding * rounding))
      break;
  }
  return R;
}

/// An upper bound of the largest eigenvalue (Gershgorin), for squares of stretches in wave speeds.
template <class T>
T largest_eigenvalue_bound(const Mat3Of<T>& A) noexcept
{
  using std::abs, std::max;
  T bound = 0;
  for (int i = 0; i < 3; ++i)
    bound = max(bound, T(abs(A(i, 0)) + abs(A(i, 1)) + abs(A(i, 2))));
  return bound;
}
inline Real largest_eigenvalue_bound(const Mat3& A) noexcept { return largest_eigenvalue_bound<Real>(A); }

}  // namespace talus
