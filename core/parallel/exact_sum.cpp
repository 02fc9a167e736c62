#include "core/parallel/exact_sum.hpp"

#include <cassert>
#include <cmath>
#include <limits>

namespace talus {

namespace {

/// Passes carries from digit `low` to `high`, and beyond while carries remain.  Afterwards all digits but the highest are in [0, 2^32).
/// The highest, whose index is returned, has the sign of the sum and a size below 2^31.
int pass_carries(std::int64_t* digit, int low, int high) noexcept
{
  const auto settled = [](std::int64_t d) { return d == static_cast<std::int32_t>(d); };
  for (int k = low; k < high || (k < ExactSum::digits - 1 && !settled(digit[k])); ++k) {
    digit[k + 1] += digit[k] >> 32;  // rounds down, so the remainder is positive
    digit[k] &= 0xffffffff;
    high = std::max(high, k + 1);
  }
  return high;
}

}  // namespace

void ExactSum::add_not_finite(Real x) noexcept { ++not_finite_[std::isnan(x) ? 0 : x > 0 ? 1 : 2]; }

ExactSum::Range ExactSum::range() const noexcept
{
  const int top = 64 - static_cast<int>(std::countl_zero(used_));
  return {static_cast<int>(std::countr_zero(used_)), top == 64 ? digits - 1 : top};
}

void ExactSum::normalise() noexcept
{
  const auto [lowest, highest] = range();
  if (lowest <= highest)
    use(pass_carries(digit_.data(), lowest, highest) - 1);
  weight_ = 1;
}

void ExactSum::add(const ExactSum& other) noexcept
{
  const auto [lowest, highest] = other.range();
  for (int k = lowest; k <= highest; ++k)
    digit_[static_cast<std::size_t>(k)] += other.digit_[static_cast<std::size_t>(k)];
  for (std::size_t i = 0; i < not_finite_.size(); ++i)
    not_finite_[i] += other.not_finite_[i];
  used_ |= other.used_;
  weight_ += other.weight_;
  if (weight_ >= heaviest)
    normalise();
}

Real ExactSum::value() const noexcept
{
  const auto [nans, rises, falls] = not_finite_;
  if ((nans | rises | falls) != 0) {
    constexpr Real infinity = std::numeric_limits<Real>::infinity();
    return nans != 0 || (rises != 0 && falls != 0) ? std::numeric_limits<Real>::quiet_NaN() : rises != 0 ? infinity : -infinity;
  }
  const auto [lowest, highest] = range();
  if (lowest > highest)
    return 0;

  std::array<std::int64_t, digits> digit;
  std::copy(digit_.begin() + lowest, digit_.begin() + highest + 1, digit.begin() + lowest);
  std::fill(digit.begin() + highest + 1, digit.begin() + std::min(highest + 4, digits), 0);  // where carries may go
  int top = pass_carries(digit.data(), lowest, highest);
  const bool negative = digit[static_cast<std::size_t>(top)] < 0;
  if (negative) {
    for (int k = lowest; k <= top; ++k)
      digit[static_cast<std::size_t>(k)] *= -1;
    top = pass_carries(digit.data(), lowest, top);
  }
  while (top > lowest && digit[static_cast<std::size_t>(top)] == 0)
    --top;
  if (digit[static_cast<std::size_t>(top)] == 0)
    return 0;

  // The leading 63 bits, the last of which also tells whether any lower bit is set: this is what correct rounding needs.  Sums below the
  // normal numbers have no more than 52 bits, so nothing is rounded twice.
  const auto at = [&, first_used = lowest](int k) {
    return k < first_used ? 0 : static_cast<std::uint64_t>(digit[static_cast<std::size_t>(k)]);
  };
  const std::uint64_t first = at(top), second = at(top - 1) << 32 | at(top - 2);
  const int width = static_cast<int>(std::bit_width(first)), drop = width + 1;  // of the 64 bits of `second`
  std::uint64_t leading = first << (63 - width) | second >> drop;
  bool more = (second & ((std::uint64_t{1} << drop) - 1)) != 0;
  for (int k = lowest; !more && k < top - 2; ++k)
    more = digit[static_cast<std::size_t>(k)] != 0;
  leading |= static_cast<std::uint64_t>(more);
  const Real size = std::ldexp(static_cast<Real>(static_cast<std::int64_t>(leading)), 32 * (top - 2) + drop - 1074);
  return negative ? -size : size;
}

void ExactSum::clear() noexcept
{
  if (const auto [lowest, highest] = range(); lowest <= highest)
    std::fill(digit_.begin() + lowest, digit_.begin() + highest + 1, 0);
  not_finite_ = {};
  used_ = 0;
  weight_ = 0;
}

void ExactSum::write(std::span<std::int64_t> to) const noexcept
{
  assert(to.size() == words);
  std::copy(digit_.begin(), digit_.end(), to.begin());
  std::copy(not_finite_.begin(), not_finite_.end(), to.begin() + digits);
  if (const auto [lowest, highest] = range(); lowest <= highest)
    pass_carries(to.data(), lowest, highest);
}

void ExactSum::add(std::span<const std::int64_t> from) noexcept
{
  assert(from.size() == words);
  for (int k = 0; k < digits; ++k)
    if (const std::int64_t d = from[static_cast<std::size_t>(k)]; d != 0) {
      digit_[static_cast<std::size_t>(k)] += d;
      use(k);
    }
  for (std::size_t i = 0; i < not_finite_.size(); ++i)
    not_finite_[i] += from[digits + i];
  if (++weight_ >= heaviest)
    normalise();
}

void add_each(std::span<const Real> x, std::span<ExactSum> sums) noexcept
{
  for (std::size_t i = 0; i < x.size(); ++i)
    sums[i].add(x[i]);
}

void values_of(std::span<const ExactSum> sums, std::span<Real> x) noexcept
{
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = sums[i].value();
}

void clear_each(std::span<ExactSum> sums) noexcept
{
  for (ExactSum& sum : sums)
    sum.clear();
}

void write_each(std::span<const ExactSum> sums, std::span<std::int64_t> to) noexcept
{
  for (std::size_t i = 0; i < sums.size(); ++i)
    sums[i].write(to.subspan(i * ExactSum::words, ExactSum::words));
}

void add_written(std::span<const std::int64_t> from, std::span<ExactSum> sums) noexcept
{
  for (std::size_t i = 0; i < sums.size(); ++i)
    sums[i].add(from.subspan(i * ExactSum::words, ExactSum::words));
}

}  // namespace talus
