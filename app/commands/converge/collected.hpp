#pragma once
// Numbers of a run by their names: of its summary, or of a column of its history.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/output/csv.hpp"
#include "io/output/run_summary.hpp"

namespace talus {

/// The column that a name such as "max(toe)" or "toe" asks for.
std::string column_of(const std::string& name);

/// The last value of a column that is not NaN, or with "max(toe)" or "min(toe)" its largest or smallest.  NaN if all are; nothing if
/// there is no such column.
std::optional<NamedValue> of_history(const HistoryTable& history, const std::string& name);

/// The number of the summary with that name (find_number() of io/output/summary_json.hpp), or that of the history.
std::optional<NamedValue> collected(const std::vector<NamedValue>& summary, const std::optional<HistoryTable>& history,
                                    const std::string& name);

/// All names of numbers, without those that the statistics of columns have.
std::vector<std::string> known_names(const std::vector<NamedValue>& summary, const std::optional<HistoryTable>& history);

/// The history in the results folder of a run; nothing if it has none.  Throws EnvironmentError.
std::optional<HistoryTable> history_in(const std::filesystem::path& folder);

}  // namespace talus
