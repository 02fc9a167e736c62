#pragma once
// Values that are not known for certain: how they are spread, and samples of them.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/fields.hpp"

namespace talus {

/// Between two values; with `mode`, most likely there (triangular); with `mean` and `deviation`, normal, cut off at the two values.
struct Spread {
  std::optional<Real> low, mode, high, mean, deviation;
  static constexpr auto fields()
  {
    return std::tuple{optional("low", &Spread::low, any, "-", "lowest value"),
                      optional("mode", &Spread::mode, any, "-", "likeliest value: then triangular, without it uniform"),
                      optional("high", &Spread::high, any, "-", "highest value"),
                      optional("mean", &Spread::mean, any, "-", "of a normal distribution"),
                      optional("deviation", &Spread::deviation, positive, "-",
                               "standard deviation; cut off at low and high, by default three of them from the mean")};
  }
  /// Rules between them, in words.
  void check(std::vector<std::string>& problems) const;
};

/// The value that a share 0 < p < 1 of all is below.
Real quantile(const Spread& spread, Real p) noexcept;

/// A low, a middle and a high value: the ends and the mode, or the middle between the ends; of a normal distribution the mean and one deviation
/// to either side, as far as it is not cut off.
struct LowMiddleHigh {
  Real low, middle, high;
};
LowMiddleHigh three_of(const Spread& spread) noexcept;

/// `count` shares between 0 and 1, one in each of as many equal parts, in random order: a column of a Latin hypercube (McKay, Beckman & Conover
/// 1979, Technometrics 21, 239).  Each key has random numbers of its own, so that one more leaves the others as they are; the same on any machine.
std::vector<Real> latin_column(std::string_view key, std::uint64_t seed, std::size_t count);

}  // namespace talus
