#pragma once
// The numbers of a convergence study: chosen from the results of its levels, judged, and written as tables.
#include <span>
#include <string>
#include <vector>

#include "app/commands/converge/converge_levels.hpp"
#include "app/commands/converge/richardson.hpp"

namespace talus {

struct ConvergeNumber {
  std::string name, unit;
  std::vector<Real> values;  ///< in the order of the levels; NaN where there is none
  Extrapolation judged;
  /// The uncertainty over the finest value [-]; nothing if there is no uncertainty or the value is zero.
  std::optional<Real> relative() const noexcept;
  bool is_told() const noexcept { return judged.verdict == Convergence::converges || judged.verdict == Convergence::constant; }
};

/// The numbers with the names in `collect`.  If it is empty: the last value of each column of the history of the finest level, its largest
/// or smallest value if that is not near its first or its last one, and the physical results in its summary.  All levels have to be done.
/// Changes below 1e-9 of the largest value with the same unit in that history count as rounding.  Throws Error with all names that no level
/// has; EnvironmentError.
std::vector<ConvergeNumber> numbers_of(const ConvergePlan& plan, const std::vector<std::string>& collect);

/// The levels as text: folder, size, cells, particles, state, changes.
std::string print_levels(const ConvergePlan& plan);

/// The numbers as text of 100 columns, with the three finest levels; numbers that are zero at all levels are only counted.
std::string print_numbers(const ConvergePlan& plan, std::span<const ConvergeNumber> numbers);

/// Sentences on the numbers that do not converge, one for each verdict.
std::vector<std::string> complaints(std::span<const ConvergeNumber> numbers);

/// The text of convergence.csv.
std::string convergence_csv(const ConvergePlan& plan, std::span<const ConvergeNumber> numbers);

/// The text of convergence.json.
std::string convergence_json(const ConvergePlan& plan, Real ratio, std::span<const ConvergeNumber> numbers,
                             const std::vector<std::string>& warnings);

}  // namespace talus
