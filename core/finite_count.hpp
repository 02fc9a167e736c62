#pragma once
// Conversion of floating-point numbers to counts that may be too large for an integer, such as the steps of 1e18 seconds.  A plain
// conversion would be undefined behaviour and may give a negative count.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "core/types.hpp"

namespace talus {

/// The largest count.  It is well below the largest 64-bit integer, so that a few of them can be added.
inline constexpr std::int64_t most_counted = 1'000'000'000'000'000'000;

/// The integer part of a number, limited to [-most_counted, most_counted].  NaN gives most_counted.
inline std::int64_t counted(Real x) noexcept
{
  constexpr auto most = static_cast<Real>(most_counted);
  if (!(std::abs(x) < most))
    return x < 0 ? -most_counted : most_counted;
  return static_cast<std::int64_t>(x);
}

/// The sum of two such counts that are not negative, at most most_counted.
inline std::int64_t counted_sum(std::int64_t a, std::int64_t b) noexcept { return std::min(a + b, most_counted); }

inline std::string count_in_words(std::int64_t n) { return n >= most_counted ? "more than 1e18" : fmt::format("{}", n); }

}  // namespace talus
