#pragma once
// sweep.csv: a row for each case with its values, how far it is, and numbers of those that are done.
#include <optional>

#include "app/commands/sweep/sweep_cases.hpp"
#include "io/output/csv.hpp"

namespace talus {

class SweepTable {
 public:
  explicit SweepTable(const SweepPlan& plan);

  /// Looks at all cases that were not done when it looked before, and writes DIR/sweep.csv as a whole.  Other processes may do so too.
  /// EnvironmentError.
  void update();
  const CaseStatus& status(std::size_t i) const { return status_[i]; }
  /// Headings of the numbers, "toe [m]"; and one of them of a case, nothing where it is not known.
  std::vector<std::string> number_headings() const;
  std::optional<Real> number(std::size_t i, std::size_t k) const;
  /// Lines of columns for people.
  std::string print() const;
  /// Names of `collect` that no case knows of those that are done, with what was probably meant.
  std::vector<std::string> unknown_names() const;

 private:
  struct Row {
    std::vector<std::optional<NamedValue>> numbers;
    std::vector<std::string> known;  ///< names that there are, where one was not found
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
