#pragma once
// sweep.csv: a row for each case with its values, its state, and numbers of completed cases.
#include <optional>

#include "app/commands/sweep/sweep_cases.hpp"
#include "io/output/csv.hpp"

namespace talus {

class SweepTable {
 public:
  explicit SweepTable(const SweepPlan& plan);

  /// Reads all cases that were not done at the last call, and rewrites DIR/sweep.csv atomically.  Other processes may do so at the same
  /// time.  Throws EnvironmentError.
  void update();
  const CaseStatus& status(std::size_t i) const { return status_[i]; }
  /// The headings of the numbers, such as "toe [m]"; and one number of a case, nothing if it is unknown.
  std::vector<std::string> number_headings() const;
  std::optional<Real> number(std::size_t i, std::size_t k) const;
  /// The table as text.
  std::string print() const;
  /// The names in `collect` that no completed case has, with suggestions.
  std::vector<std::string> unknown_names() const;

 private:
  struct Row {
    std::vector<std::optional<NamedValue>> numbers;
    std::vector<std::string> known;  ///< existing names, if one was not found
  };
  Row row_of(std::size_t i) const;
  std::vector<CsvColumn> columns() const;
  std::vector<std::string> words_of_case(std::size_t i) const;

  const SweepPlan& plan_;
  std::vector<std::string> names_;
  std::vector<CaseStatus> status_;
  std::vector<Row> rows_;
};

}  // namespace talus
