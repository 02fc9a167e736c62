#pragma once
// Principal values and axes of a symmetric trace-free 3x3 tensor without branches, for one tensor or one per lane.
#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <numbers>

#include "core/simd.hpp"
#include "core/tensor.hpp"
#include "materials/parts/power_near.hpp"

namespace talus {

template <class T>
using Vec3Of = Eigen::Matrix<T, 3, 1, Eigen::DontAlign>;

/// As where() for tensors.
template <class T>
Vec3Of<T> where(const MaskOf<T>& condition, const Vec3Of<T>& a, const Vec3Of<T>& b) noexcept
{
  return {where(condition, a[0], b[0]), where(condition, a[1], b[1]), where(condition, a[2], b[2])};
}

/// Values in descending order, and axes of unit length.
template <class T>
struct PrincipalAxes {
  Vec3Of<T> values;
  Vec3Of<T> first, last;  ///< axes of the largest and of the smallest value; the third one is normal to both
  /// The tensor with these axes and other values.  Written by differences, so that equal values need no axes and an isotropic tensor is one
  /// to the last digit.
  Sym3Of<T> tensor(const Vec3Of<T>& with) const noexcept
  {
    const T above = with[0] - with[1], below = with[2] - with[1];
    const auto entry = [&](int i, int j) -> T { return above * first[i] * first[j] + below * last[i] * last[j]; };
    Sym3Of<T> a;
    a << with[1] + entry(0, 0), with[1] + entry(1, 1), with[1] + entry(2, 2), entry(0, 1), entry(1, 2), entry(0, 2);
    return a;
  }
};

/// A symmetric trace-free tensor by its size sqrt(J2) and its direction, the tensor over its size.  In units of the size the principal
/// values are the roots of t^3 - t - J3 = 0.  One of them is at least 1 from the other two, which may be equal: that one is found first
/// and keeps all its digits, as does its axis; the others follow in the plane normal to it.  [Eberly 2021, A Robust Eigensolver for 3x3
/// Symmetric Matrices, Geometric Tools]
template <class T>
class ShearDirection {
 public:
  ShearDirection(const Sym3Of<T>& tensor, const T& size) noexcept : size_(size), direction_(tensor * T(1 / above_nothing(size)))
  {
    using std::abs, std::min;
    const Sym3Of<T>& e = direction_;
    const T J3 = e[0] * (e[1] * e[2] - e[4] * e[4]) - e[3] * (e[3] * e[2] - e[4] * e[5]) + e[5] * (e[3] * e[4] - e[1] * e[5]);
    upper_ = J3 >= 0;
    const T j = min(T(abs(J3)), T(largest_J3));
    // The parabola is right to 0.002; Newton's method leaves 4e-6, 2e-11 and less than a rounding.  Its divisor is at least 2.
    T t = 1 + j * (0.5 - 0.255 * j);
    for (int i = 0; i < 3; ++i)
      t -= ((t * t - 1) * t - j) / (3 * t * t - 1);
    apart_ = where(upper_, t, -t);
  }

  /// The largest and the smallest principal value without axes; where two values are nearly equal they have half of the digits.
  std::array<T, 2> rough_extremes() const noexcept
  {
    using std::max, std::sqrt;
    const T half = sqrt(max(T(1 - 0.75 * apart_ * apart_), T(0))), middle = -0.5 * apart_;
    return {size_ * where(upper_, apart_, middle + half), size_ * where(upper_, middle - half, apart_)};
  }

  PrincipalAxes<T> axes() const noexcept
  {
    using std::abs, std::sqrt;
    const Vec3Of<T> n = axis_apart();
    // Two unit vectors normal to n; the first is along the plane of coordinates in which n is longer.
    const auto x_longer = abs(n[0]) > abs(n[1]);
    const Vec3Of<T> turned{where(x_longer, -n[2], 0), where(x_longer, 0, n[2]), where(x_longer, n[0], -n[1])};
    const Vec3Of<T> u = over(turned, sqrt(T(turned.squaredNorm()))), w = n.cross(u);
    const Mat3Of<T> e = unpack(direction_);
    const Vec3Of<T> eu = e * u, ew = e * w;
    const T uu = u.dot(eu), ww = w.dot(ew), uw = u.dot(ew);
    const T half = 0.5 * (uu - ww), radius = sqrt(T(half * half + uw * uw)), middle = 0.5 * (uu + ww);
    // Components of the axis of the larger value, without cancellation: (radius + half, uw) or (uw, radius - half).
    const T sum = radius + abs(half), longer = where(sum > 0, sum, 1), length = sqrt(T(longer * longer + uw * uw));
    const auto mainly_u = half >= 0;
    const T along_u = where(mainly_u, longer, uw) / length, along_w = where(mainly_u, uw, longer) / length;
    const Vec3Of<T> high = along_u * u + along_w * w, low = along_u * w - along_w * u;
    const T apart = n.dot(e * n), higher = middle + radius, lower = middle - radius;
    PrincipalAxes<T> found;
    found.values = where<T>(upper_, Vec3Of<T>(apart, higher, lower), Vec3Of<T>(higher, lower, apart)) * size_;
    found.first = where<T>(upper_, n, high);
    found.last = where<T>(upper_, low, n);
    return found;
  }

 private:
  static constexpr Real largest_J3 = 2 / (3 * std::numbers::sqrt3);  ///< of a tensor of size one: two values are equal

  /// By divisions, after which the axes of a diagonal tensor are those of the coordinates exactly.
  static Vec3Of<T> over(const Vec3Of<T>& a, const T& length) noexcept { return {a[0] / length, a[1] / length, a[2] / length}; }

  /// The unit vector normal to the rows of direction - apart I, of which two at least are far from parallel: the longest of their products.
  Vec3Of<T> axis_apart() const noexcept
  {
    using std::sqrt;
    const Sym3Of<T>& e = direction_;
    const Vec3Of<T> x{e[0] - apart_, e[3], e[5]}, y{e[3], e[1] - apart_, e[4]}, z{e[5], e[4], e[2] - apart_};
    const Vec3Of<T> xy = x.cross(y), yz = y.cross(z), zx = z.cross(x);
    const T of_xy = xy.squaredNorm(), of_yz = yz.squaredNorm(), of_zx = zx.squaredNorm();
    const auto yz_longer = of_yz > of_xy;
    const Vec3Of<T> longer = where<T>(yz_longer, yz, xy);
    const T of_longer = where(yz_longer, of_yz, of_xy);
    const auto zx_longest = of_zx > of_longer;
    return over(where<T>(zx_longest, zx, longer), sqrt(where(zx_longest, of_zx, of_longer)));
  }

  T size_;
  Sym3Of<T> direction_;
  MaskOf<T> upper_;  ///< whether the value apart is the largest; otherwise it is the smallest
  T apart_;          ///< the value apart, of the direction
};

}  // namespace talus
