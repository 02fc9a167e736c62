#pragma once
// Packs of numbers.  Sums over a stencil run over whole packs, so that they use the vector unit without a scalar remainder.  For laws,
// SimdReal holds one number of several particles and is used like a Real.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "core/types.hpp"

namespace talus {

/// Numbers per pack.  Stencils are padded to whole packs with zero weights.
inline constexpr int pack_size = 4;
constexpr int padded(int n) noexcept { return (n + pack_size - 1) / pack_size * pack_size; }

using Pack = Real __attribute__((vector_size(pack_size * sizeof(Real))));

/// Loads a pack from an aligned address.
inline Pack load(const Real* from) noexcept { return *reinterpret_cast<const Pack*>(__builtin_assume_aligned(from, sizeof(Pack))); }
inline void store(Real* to, const Pack& pack) noexcept { *reinterpret_cast<Pack*>(__builtin_assume_aligned(to, sizeof(Pack))) = pack; }
inline Real sum(const Pack& a) noexcept { return (a[0] + a[1]) + (a[2] + a[3]); }
/// A pack at any address.  (The compiler would split a memcpy into halves, and the following load would wait for both.)
using LoosePack = Real __attribute__((vector_size(sizeof(Pack)), aligned(sizeof(Real)), may_alias));

/// Transposes four by four numbers.
inline void transpose(Pack& a, Pack& b, Pack& c, Pack& d) noexcept
{
  const Pack ab_even = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab_odd = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Pack cd_even = __builtin_shufflevector(c, d, 0, 4, 2, 6), cd_odd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  a = __builtin_shufflevector(ab_even, cd_even, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5);
  c = __builtin_shufflevector(ab_even, cd_even, 2, 3, 6, 7);
  d = __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7);
}
/// Loads four numbers from any address.
[[gnu::always_inline]] inline Pack load_loose(const Real* from) noexcept { return *reinterpret_cast<const LoosePack*>(from); }
[[gnu::always_inline]] inline void store_loose(Real* to, const Pack& pack) noexcept { *reinterpret_cast<LoosePack*>(to) = pack; }
/// Calls take(k, pack) for n consecutive numbers of four rows, with one row per lane, from number `begin` on.  Whole packs are read,
/// so up to three numbers behind a row, which are never used.
template <int n, int begin = 0, class Take>
[[gnu::always_inline]] inline void load_rows(const Real* const (&row)[pack_size], Take&& take) noexcept
{
  if constexpr (n == begin + 1) {  // not worth transposing
    take(begin, Pack{row[0][begin], row[1][begin], row[2][begin], row[3][begin]});
  } else if constexpr (n > begin) {
    Pack a = load_loose(row[0] + begin), b = load_loose(row[1] + begin), c = load_loose(row[2] + begin), d = load_loose(row[3] + begin);
    transpose(a, b, c, d);
    take(begin, a), take(begin + 1, b);
    if constexpr (n > begin + 2)
      take(begin + 2, c);
    if constexpr (n > begin + 3)
      take(begin + 3, d);
    load_rows<n, begin + pack_size>(row, take);
  }
}
static_assert(pack_size == 4);

/// One number of several particles, one per lane.  A template for Real also works for SimdReal if it has no `if` on values: `where` selects
/// values instead, and any_of and all_of test all lanes at once.
struct SimdReal {
  Pack of;
  /// The lanes for which a condition holds.
  struct Mask {
    using Bits = std::int64_t __attribute__((vector_size(sizeof(Pack))));
    Bits of;
    bool operator[](int lane) const noexcept { return of[lane] != 0; }
    friend Mask operator&&(const Mask& a, const Mask& b) noexcept { return {a.of & b.of}; }
    friend Mask operator||(const Mask& a, const Mask& b) noexcept { return {a.of | b.of}; }
    friend Mask operator!(const Mask& a) noexcept { return {~a.of}; }
  };

  // cppcheck-suppress uninitMemberVar ; as that of a Real is
  SimdReal() = default;
  SimdReal(Real all) noexcept : of{all, all, all, all} {}  // NOLINT(google-explicit-constructor): a number is a number in every lane
  SimdReal(const Pack& each) noexcept : of(each) {}        // NOLINT(google-explicit-constructor)
  Real operator[](int lane) const noexcept { return of[lane]; }
  void set(int lane, Real to) noexcept { of[lane] = to; }

  SimdReal& operator+=(const SimdReal& b) noexcept { return of += b.of, *this; }
  SimdReal& operator-=(const SimdReal& b) noexcept { return of -= b.of, *this; }
  SimdReal& operator*=(const SimdReal& b) noexcept { return of *= b.of, *this; }
  SimdReal& operator/=(const SimdReal& b) noexcept { return of /= b.of, *this; }
  friend SimdReal operator+(const SimdReal& a, const SimdReal& b) noexcept { return a.of + b.of; }
  friend SimdReal operator-(const SimdReal& a, const SimdReal& b) noexcept { return a.of - b.of; }
  friend SimdReal operator*(const SimdReal& a, const SimdReal& b) noexcept { return a.of * b.of; }
  friend SimdReal operator/(const SimdReal& a, const SimdReal& b) noexcept { return a.of / b.of; }
  friend SimdReal operator-(const SimdReal& a) noexcept { return -a.of; }
  friend Mask operator<(const SimdReal& a, const SimdReal& b) noexcept { return {a.of < b.of}; }
  friend Mask operator>(const SimdReal& a, const SimdReal& b) noexcept { return {a.of > b.of}; }
  friend Mask operator<=(const SimdReal& a, const SimdReal& b) noexcept { return {a.of <= b.of}; }
  friend Mask operator>=(const SimdReal& a, const SimdReal& b) noexcept { return {a.of >= b.of}; }
  friend Mask operator==(const SimdReal& a, const SimdReal& b) noexcept { return {a.of == b.of}; }
};

/// `a` where the condition holds, else `b`; both are evaluated.
inline SimdReal where(const SimdReal::Mask& condition, const SimdReal& a, const SimdReal& b) noexcept { return condition.of ? a.of : b.of; }
inline Real where(bool condition, Real a, Real b) noexcept { return condition ? a : b; }
inline bool any_of(const SimdReal::Mask& mask) noexcept { return ((mask.of[0] | mask.of[1]) | (mask.of[2] | mask.of[3])) != 0; }
inline bool all_of(const SimdReal::Mask& mask) noexcept { return ((mask.of[0] & mask.of[1]) & (mask.of[2] & mask.of[3])) != 0; }
inline bool any_of(bool condition) noexcept { return condition; }
inline bool all_of(bool condition) noexcept { return condition; }
/// The type of a condition: bool for a Real, SimdReal::Mask for SimdReal.
template <class T>
using MaskOf = decltype(std::declval<T>() > std::declval<T>());
/// As where() above for tensors, entry by entry.
template <class T>
Sym3Of<T> where(const MaskOf<T>& condition, const Sym3Of<T>& a, const Sym3Of<T>& b) noexcept
{
  Sym3Of<T> chosen;
  for (int k = 0; k < 6; ++k)
    chosen[k] = where(condition, a[k], b[k]);
  return chosen;
}

/// Calls f(lane) for every lane, for functions without a vector form.
template <class F>
SimdReal in_each_lane(F&& f) noexcept
{
  return Pack{f(0), f(1), f(2), f(3)};
}

namespace detail {
/// Calls f(array) with Eigen's vectorised functions.
template <class F>
SimdReal by_array(const SimdReal& a, F&& f) noexcept
{
  using Array = Eigen::Array<Real, pack_size, 1>;
  Array x;
  std::memcpy(x.data(), &a.of, sizeof(Pack));
  const Array y = f(x);
  SimdReal result;
  std::memcpy(&result.of, y.data(), sizeof(Pack));
  return result;
}

/// The range of log_of_normal and of exp_of_moderate.
inline constexpr Real least_normal = 1e-300, moderate = 700;
/// ln(a) for a from least_normal to its inverse, where nothing has to be told apart.  a = 2^k m with m from sqrt(1/2) to sqrt(2) and
/// s = (m - 1) / (m + 1); the polynomial in s^2 and the order of the sums are those of fdlibm (Sun Microsystems 1993, e_log.c), below one
/// unit in the last place.
inline Pack log_of_normal(const Pack& a) noexcept
{
  using Bits = SimdReal::Mask::Bits;
  constexpr std::int64_t one = 0x3ff0000000000000, root_half = 0x3fe6a09e667f3bcd, mantissa = 0x000fffffffffffff;
  constexpr std::int64_t magic = 0x4330000000000000;  // 2^52, whose last bits count ones
  constexpr Real counted = 4503599627370496.0 + 1023;
  const Bits shifted = reinterpret_cast<Bits>(a) + (one - root_half);
  const Pack k = reinterpret_cast<Pack>((shifted >> 52) | magic) - counted;
  const Pack f = reinterpret_cast<Pack>((shifted & mantissa) + root_half) - 1;
  const Pack s = f / (2 + f), z = s * s, w = z * z, half_square = 0.5 * f * f;
  const Pack even = w * (0.3999999999940941908 + w * (0.2222219843214978396 + w * 0.1531383769920937332));
  const Pack odd = z * (0.6666666666666735130 + w * (0.2857142874366239149 + w * (0.1818357216161805012 + w * 0.1479819860511658591)));
  constexpr Real ln2_high = 6.93147180369123816490e-01, ln2_low = 1.90821492927058770002e-10;
  return k * ln2_high - ((half_square - (s * (half_square + (even + odd)) + k * ln2_low)) - f);
}
/// exp(a) for moderate |a|.  a = n ln 2 + r with |r| up to ln(2) / 2; the first term that the series of exp(r) leaves out is below
/// 0.347^14 / 14! = 4e-18.  Even and odd powers are two chains, which the processor computes side by side.
inline Pack exp_of_moderate(const Pack& a) noexcept
{
  using Bits = SimdReal::Mask::Bits;
  constexpr Real magic = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to a whole number, which the last bits hold
  constexpr Real ln2_high = 6.93147180369123816490e-01, ln2_low = 1.90821492927058770002e-10, per_ln2 = 1.44269504088896338700;
  const Pack sum = a * per_ln2 + magic, n = sum - magic;
  const Pack r = (a - n * ln2_high) - n * ln2_low, r2 = r * r;
  Pack even = Pack{} + 1.0 / 479001600, odd = Pack{} + 1.0 / 6227020800;
  even = 1.0 / 3628800 + even * r2, odd = 1.0 / 39916800 + odd * r2;
  even = 1.0 / 40320 + even * r2, odd = 1.0 / 362880 + odd * r2;
  even = 1.0 / 720 + even * r2, odd = 1.0 / 5040 + odd * r2;
  even = 1.0 / 24 + even * r2, odd = 1.0 / 120 + odd * r2;
  even = 0.5 + even * r2, odd = 1.0 / 6 + odd * r2;
  const Pack power = 1 + (r + r2 * (even + r * odd));
  return reinterpret_cast<Pack>(reinterpret_cast<Bits>(power) + (reinterpret_cast<Bits>(sum) << 52));
}
}  // namespace detail

// Mathematical functions, found by argument-dependent lookup beside `using std::sqrt`.  Logarithm and exponential are accurate to 2 units
// in the last place; those of Eigen, which tell zero, infinity and NaN apart, only where a lane needs it.
inline SimdReal sqrt(const SimdReal& a) noexcept
{
  return detail::by_array(a, [](const auto& x) { return x.sqrt(); });
}
inline SimdReal abs(const SimdReal& a) noexcept { return a.of < 0 ? -a.of : a.of; }
inline SimdReal max(const SimdReal& a, const SimdReal& b) noexcept { return a.of < b.of ? b.of : a.of; }
inline SimdReal min(const SimdReal& a, const SimdReal& b) noexcept { return b.of < a.of ? b.of : a.of; }
inline SimdReal::Mask isfinite(const SimdReal& a) noexcept { return abs(a) <= std::numeric_limits<Real>::max(); }
inline SimdReal log(const SimdReal& a) noexcept
{
  if (all_of(a >= detail::least_normal && a <= 1 / detail::least_normal))
    return detail::log_of_normal(a.of);
  return detail::by_array(a, [](const auto& x) { return x.log(); });
}
inline SimdReal exp(const SimdReal& a) noexcept
{
  if (all_of(abs(a) <= detail::moderate))
    return detail::exp_of_moderate(a.of);
  return detail::by_array(a, [](const auto& x) { return x.exp(); });
}
/// a^n for a > 0, accurate to 2 |n ln a| units in the last place, twice the error of the logarithm; 0 for a = 0 with n > 0.
inline SimdReal pow(const SimdReal& a, Real n) noexcept
{
  const auto nothing = a == 0 && SimdReal(n) > 0;
  return where(nothing, 0, exp(n * log(where(nothing, 1, a))));
}

/// ln(1 + a), accurate for small a.
inline SimdReal log1p(const SimdReal& a) noexcept
{
  // 2 artanh(s): the first term that the series leaves out is below 0.0527^16 / 17 of the first.
  constexpr Real near = 0.1;
  if (all_of(abs(a) <= near)) {
    const SimdReal s = a / (2 + a), s2 = s * s;
    SimdReal sum = 1.0 / 15;
    for (int k = 13; k >= 3; k -= 2)
      sum = 1.0 / k + sum * s2;
    return 2 * s + 2 * s * (s2 * sum);
  }
  // The rounding of 1 + a affects logarithm and denominator in the same ratio.  [Kahan; Higham 2002, ch. 1.14.1]
  const SimdReal u = 1 + a, rounded = u - 1;
  return where(rounded == 0 || !isfinite(u), where(u < 0, std::numeric_limits<Real>::quiet_NaN(), a), log(u) * (a / rounded));
}
/// exp(a) - 1, accurate for small a.
inline SimdReal expm1(const SimdReal& a) noexcept
{
  // The first term that the series leaves out is below 0.1^11 / 12! of the first.
  constexpr Real near = 0.1;
  if (all_of(abs(a) <= near)) {
    SimdReal sum = 1;
    for (int k = 11; k >= 3; --k)
      sum = 1 + sum * a * (1.0 / k);
    return a + a * (0.5 * a * sum);
  }
  // The same method as in log1p; beyond the middle range exp(a) alone is as accurate.
  const SimdReal u = exp(a), rounded = u - 1;
  return where(abs(a) < 1, where(rounded == 0, a, rounded * (a / log(u))), rounded);
}

}  // namespace talus

template <>
struct Eigen::NumTraits<talus::SimdReal> : Eigen::GenericNumTraits<talus::SimdReal> {
  using Real = talus::SimdReal;
  using NonInteger = talus::SimdReal;
  using Literal = talus::SimdReal;
  // NOLINTNEXTLINE(readability-identifier-naming): Eigen's names
  enum { IsComplex = 0, IsInteger = 0, IsSigned = 1, RequireInitialization = 0, ReadCost = 1, AddCost = 1, MulCost = 1 };
};

namespace talus {

/// The tensor of one lane.
template <int R, int C>
Eigen::Matrix<Real, R, C, Eigen::DontAlign> lane_of(const Eigen::Matrix<SimdReal, R, C, Eigen::DontAlign>& all, int lane) noexcept
{
  Eigen::Matrix<Real, R, C, Eigen::DontAlign> one;
  for (int k = 0; k < R * C; ++k)
    one(k) = all(k)[lane];
  return one;
}

}  // namespace talus
