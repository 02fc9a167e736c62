#include "app/commands/converge/collected.hpp"

#include <cmath>
#include <cstdint>
#include <utility>

#include "io/output/summary_json.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// The statistic of a column of a history.
enum class Of : std::uint8_t { last, max, min };

/// Parses "max(toe)" as the maximum of toe; a name alone means its last entry.
std::pair<Of, std::string> column_asked(const std::string& name)
{
  for (const auto& [word, of] : {std::pair("last(", Of::last), std::pair("max(", Of::max), std::pair("min(", Of::min)})
    if (name.starts_with(word) && name.ends_with(')'))
      return {of, name.substr(std::string_view(word).size(), name.size() - std::string_view(word).size() - 1)};
  return {Of::last, name};
}

}  // namespace

std::string column_of(const std::string& name) { return column_asked(name).second; }

std::optional<NamedValue> of_history(const HistoryTable& history, const std::string& name)
{
  const auto [of, column] = column_asked(name);
  for (std::size_t c = 0; c < history.columns.size(); ++c) {
    if (history.columns[c].name != column)
      continue;
    NamedValue found{name, std::nan(""), history.columns[c].unit};
    for (const Real value : history.values[c])
      if (!std::isnan(value) && (of == Of::last || std::isnan(found.value) || (of == Of::max ? value > found.value : value < found.value)))
        found.value = value;
    return found;
  }
  return std::nullopt;
}

std::optional<NamedValue> collected(const std::vector<NamedValue>& summary, const std::optional<HistoryTable>& history,
                                    const std::string& name)
{
  if (const NamedValue* number = find_number(summary, name))
    return *number;
  return history ? of_history(*history, name) : std::nullopt;
}

std::vector<std::string> known_names(const std::vector<NamedValue>& summary, const std::optional<HistoryTable>& history)
{
  std::vector<std::string> names;
  for (const NamedValue& number : summary)
    names.push_back(number.name);
  if (history)
    for (const CsvColumn& column : history->columns)
      names.push_back(column.name);
  return names;
}

std::optional<HistoryTable> history_in(const fs::path& folder)
{
  const fs::path file = folder / "history.csv";
  if (std::error_code unknown; !fs::exists(file, unknown))
    return std::nullopt;
  return read_history(file);
}

}  // namespace talus
