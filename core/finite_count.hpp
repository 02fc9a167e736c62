#pragma once
// Counts too large to be reached, such as the steps of 1e18 seconds: a floating-point number that is turned into an integer too small
// for it is undefined behaviour, and shows as a negative count.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "core/types.hpp"

namespace talus {

/// The most that is counted of anything: well below what the integer holds, so that some of them can be added.
inline constexpr std::int64_t most_counted = 1'000'000'000'000'000'000;

/// The integer part of a number, at most most_counted and at least -most_counted.  What is no number counts as the most.
inline std::int64_t counted(Real x) noexcept
{
  constexpr auto most = static_cast<Real>(most_counted);
  if (!(std::abs(x) < most))
    return x < 0 ? -most_counted : most_counted;
  return static_cast<std::int64_t>(x);
}

/// A sum of two such counts that are not negative.
inline std::int64_t counted_sum(std::int64_t a, std::int64_t b) noexcept { return std::min(a + b, most_counted); }

inline std::string count_in_words(std::int64_t n) { return n >= most_counted ? "more than 1e18" : fmt::format("{}", n); }

}  // namespace talus
