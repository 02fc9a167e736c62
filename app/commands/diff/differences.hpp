#pragma once
// How far the values of two runs are apart: what belongs together, and what differs.  Knows nothing of files.
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// Rows of two lists that belong together, and those that stand alone; all in ascending order of what they were matched by.
struct Pairs {
  std::vector<std::pair<std::size_t, std::size_t>> both;
  std::vector<std::size_t> only_a, only_b;
};

/// By time, equal to a relative 1e-12.  Both lists must ascend.
Pairs match_times(std::span<const Real> a, std::span<const Real> b);
/// By number, in any order; no number twice in one list.
Pairs match_ids(std::span<const std::int64_t> a, std::span<const std::int64_t> b);

/// Largest modulus of what is a finite number; 0 for none.
Real largest_modulus(std::span<const Real> values);

/// How far the values of some rows are apart.
struct Gap {
  std::int64_t values = 0, differing = 0;  ///< compared; of which further apart than allowed
  Real largest = 0;                        ///< |a - b|; infinite where only one is a number, or where only one is infinite
  std::size_t pair = 0;                    ///< of the rows, the one with the largest difference
  int component = 0;                       ///< of that row
  Real a = 0, b = 0;                       ///< the two values there
};

/// Compares `components` values for each pair of rows.  Values differ that are further apart than `tolerance` (same unit) or of which
/// only one is NaN or infinite; NaN is the same as NaN, 0 as -0.
Gap compare(std::span<const Real> a, std::span<const Real> b, int components, std::span<const std::pair<std::size_t, std::size_t>> rows,
            Real tolerance);

}  // namespace talus
