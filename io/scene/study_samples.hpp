#pragma once
// Uncertain values: their distributions, and samples of them.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/fields.hpp"

namespace talus {

/// A distribution between two values: uniform; with `mode`, triangular; with `mean` and `deviation`, normal and truncated at the two
/// values.
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
  /// Adds the broken rules between its keys.
  void check(std::vector<std::string>& problems) const;
};

/// The value below which a fraction 0 < p < 1 of the distribution lies.
Real quantile(const Spread& spread, Real p) noexcept;

/// A low, a middle and a high value: the ends and the mode, or the middle between the ends; for a normal distribution the mean and one
/// deviation to either side, within the truncation.
struct LowMiddleHigh {
  Real low, middle, high;
};
LowMiddleHigh three_of(const Spread& spread) noexcept;

/// `count` numbers between 0 and 1, one in each of as many equal intervals, in random order: a column of a Latin hypercube (McKay, Beckman
/// & Conover 1979, Technometrics 21, 239).  Each key has its own random numbers, so that a further key does not change the others; the
/// numbers are equal on all machines.
std::vector<Real> latin_column(std::string_view key, std::uint64_t seed, std::size_t count);

}  // namespace talus
