#pragma once
// Matching of the items of two runs and comparison of their values, independent of files.
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// The matched rows of two lists, and unmatched ones; each in ascending order of the matching key.
struct Pairs {
  std::vector<std::pair<std::size_t, std::size_t>> both;
  std::vector<std::size_t> only_a, only_b;
};

/// Matches times that are equal within a relative 1e-12.  Both lists must ascend.
Pairs match_times(std::span<const Real> a, std::span<const Real> b);
/// Matches ids in any order; no id may be repeated in a list.
Pairs match_ids(std::span<const std::int64_t> a, std::span<const std::int64_t> b);

/// The largest absolute value among the finite numbers; 0 if there are none.
Real largest_modulus(std::span<const Real> values);

/// The difference between the values of some rows.
struct Gap {
  std::int64_t values = 0, differing = 0;  ///< number of compared values, and of those with a difference above the tolerance
  Real largest = 0;                        ///< largest |a - b|; infinite if only one is a number, or only one is infinite
  std::size_t pair = 0;                    ///< index of the pair of rows with the largest difference
  int component = 0;                       ///< component of the largest difference
  Real a = 0, b = 0;                       ///< the two values
};

/// Compares `components` values for each pair of rows.  Values differ if their difference is above `tolerance` (same unit), or if only one
/// is NaN or infinite; NaN equals NaN, and 0 equals -0.
Gap compare(std::span<const Real> a, std::span<const Real> b, int components, std::span<const std::pair<std::size_t, std::size_t>> rows,
            Real tolerance);

}  // namespace talus
