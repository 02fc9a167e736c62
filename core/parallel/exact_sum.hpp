#pragma once
// Sums without rounding errors: the result is bitwise independent of the order of the summands and of their distribution among threads and
// ranks.
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "core/types.hpp"

namespace talus {

/// A sum of doubles as one long integer in units of the smallest double, 2^-1074, with digits of 32 bits in words of 64 bits.  Each double
/// is added to two neighbouring words; carries are passed on once in a thousand summands.
class ExactSum {
 public:
  static constexpr int digits = 68;  ///< 66 digits hold the largest double, two more hold 2^60 such summands
  /// The number of words sent to other ranks: the digits, then the numbers of summands that were NaN, +inf and -inf.
  static constexpr std::size_t words = digits + 3;

  void add(Real x) noexcept
  {
    const auto bits = std::bit_cast<std::uint64_t>(x);
    const int exponent = static_cast<int>(bits >> 52) & 2047;
    if (exponent == 2047) [[unlikely]] {
      add_not_finite(x);
      return;
    }
    const int normal = exponent != 0;
    const std::uint64_t mantissa = (bits & ((std::uint64_t{1} << 52) - 1)) | static_cast<std::uint64_t>(normal) << 52;
    const int place = exponent - normal, first = place >> 5, shift = place & 31;
    const std::int64_t sign = -static_cast<std::int64_t>(bits >> 63);  // 0 or -1; (d ^ sign) - sign is +d or -d
    std::int64_t* digit = &digit_[static_cast<std::size_t>(first)];
    digit[0] += (static_cast<std::int64_t>(mantissa << shift & 0xffffffff) ^ sign) - sign;
    digit[1] += (static_cast<std::int64_t>(mantissa >> (32 - shift)) ^ sign) - sign;
    used_ |= static_cast<std::uint64_t>(mantissa != 0) << first;
    if (++weight_ >= heaviest) [[unlikely]]
      normalise();
  }
  void add(const ExactSum& other) noexcept;

  /// The sum, rounded once to nearest, ties to even.  A sum of zeros is +0, whatever their signs; a sum beyond the largest double is
  /// infinite.  Summands that are not finite give what IEEE arithmetic makes of them.
  Real value() const noexcept;
  /// Sets the sum to zero.  The cost of this and of value() is proportional to the number of digits in use.
  void clear() noexcept;

  /// Writes `words` words.  Words of up to 2^20 sums may be added as integers; the result is the words of the sum of all.
  void write(std::span<std::int64_t> to) const noexcept;
  /// Adds written words, or up to 2^20 written words that were added up.
  void add(std::span<const std::int64_t> from) noexcept;
  void read(std::span<const std::int64_t> from) noexcept
  {
    clear();
    add(from);
  }

 private:
  static constexpr int heaviest = 1024;
  struct Range {
    int lowest, highest;  ///< range of digits in use; empty if lowest is the larger
  };
  Range range() const noexcept;
  void use(int digit) noexcept { used_ |= std::uint64_t{1} << std::min(digit, 63); }
  void add_not_finite(Real x) noexcept;
  void normalise() noexcept;

  std::array<std::int64_t, digits> digit_{};
  std::array<std::int64_t, 3> not_finite_{};  ///< summands that were NaN, +inf, -inf
  std::uint64_t used_ = 0;                    ///< bit k: digits k and k + 1 are in use; bit 63: all from there on
  int weight_ = 0;                            ///< no word is larger than weight_ 2^52
};

/// Adds x[i] to sums[i].  This and the functions below are what all ExactSums share, compiled once.
void add_each(std::span<const Real> x, std::span<ExactSum> sums) noexcept;
void values_of(std::span<const ExactSum> sums, std::span<Real> x) noexcept;
void clear_each(std::span<ExactSum> sums) noexcept;
void write_each(std::span<const ExactSum> sums, std::span<std::int64_t> to) noexcept;
void add_written(std::span<const std::int64_t> from, std::span<ExactSum> sums) noexcept;

/// An exact sum of every entry of T, which is a Real, a Vec or a plain struct of Reals.
template <class T>
class ExactSums {
  static_assert(sizeof(T) % sizeof(Real) == 0 && alignof(T) == alignof(Real), "made of doubles only");
  static constexpr std::size_t entries = sizeof(T) / sizeof(Real);

 public:
  static constexpr std::size_t words = entries * ExactSum::words;

  void add(const T& summand) noexcept
  {
    std::array<Real, entries> x;
    std::memcpy(x.data(), static_cast<const void*>(&summand), sizeof(T));
    add_each(x, sum_);
  }
  void add(const ExactSums& other) noexcept
  {
    for (std::size_t i = 0; i < entries; ++i)
      sum_[i].add(other.sum_[i]);
  }
  T value() const noexcept
  {
    std::array<Real, entries> x;
    values_of(sum_, x);
    T sum;
    std::memcpy(static_cast<void*>(&sum), x.data(), sizeof(T));
    return sum;
  }
  void clear() noexcept { clear_each(sum_); }

  /// As ExactSum::write, entry after entry: `words` words in total.
  void write(std::span<std::int64_t> to) const noexcept { write_each(sum_, to); }
  void add(std::span<const std::int64_t> from) noexcept { add_written(from, sum_); }
  void read(std::span<const std::int64_t> from) noexcept
  {
    clear();
    add(from);
  }

 private:
  std::array<ExactSum, entries> sum_;
};

}  // namespace talus
