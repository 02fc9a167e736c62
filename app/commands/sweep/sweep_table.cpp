#include "app/commands/sweep/sweep_table.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/commands/sweep/collected.hpp"
#include "core/error.hpp"
#include "core/word_match.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/file_descriptor.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// Default numbers, after the fronts.
constexpr std::array usual_numbers{"kinetic", "plastic", "friction",       "energy.closure", "mass.removed",
                                   "fastest", "steps",   "simulated_time", "cost.wall"};

}  // namespace

SweepTable::SweepTable(const SweepPlan& plan) : plan_(plan), status_(plan.cases.size()), rows_(plan.cases.size())
{
  for (const Written& name : plan.study.collect)
    names_.push_back(name.text);
  if (names_.empty()) {
    names_ = plan.fronts;
    names_.insert(names_.end(), usual_numbers.begin(), usual_numbers.end());
  }
}

SweepTable::Row SweepTable::row_of(std::size_t i) const
{
  Row row;
  row.numbers.resize(names_.size());
  const auto& numbers = status_[i].summary.numbers;
  if (status_[i].state != CaseState::done)
    return row;
  const auto history = history_in(plan_.cases[i].folder);
  bool all_found = true;
  for (std::size_t k = 0; k < names_.size(); ++k) {
    row.numbers[k] = collected(numbers, history, names_[k]);
    all_found = all_found && row.numbers[k];
  }
  if (!all_found)
    row.known = known_names(numbers, history);
  return row;
}

std::vector<CsvColumn> SweepTable::columns() const
{
  std::vector<CsvColumn> all{{"case"}};
  for (const Varied& varied : plan_.study.vary)
    all.push_back({varied.key});
  all.push_back({"status"});
  for (std::size_t k = 0; k < names_.size(); ++k) {
    const auto has = std::find_if(rows_.begin(), rows_.end(), [&](const Row& row) { return k < row.numbers.size() && row.numbers[k]; });
    all.push_back({names_[k], has == rows_.end() ? "" : has->numbers[k]->unit});
  }
  return all;
}

std::vector<std::string> SweepTable::number_headings() const
{
  std::vector<std::string> headings;
  for (const CsvColumn& column : columns())
    headings.push_back(csv_heading(column));
  headings.erase(headings.begin(), headings.end() - std::ssize(names_));
  return headings;
}

std::optional<Real> SweepTable::number(std::size_t i, std::size_t k) const
{
  const auto& numbers = rows_[i].numbers;
  if (k >= numbers.size() || !numbers[k] || !std::isfinite(numbers[k]->value))
    return std::nullopt;
  return numbers[k]->value;
}

std::vector<std::string> SweepTable::words_of_case(std::size_t i) const
{
  std::vector<std::string> all{std::to_string(plan_.cases[i].number)};
  for (const Written& value : plan_.cases[i].values)
    all.push_back(value.text);
  all.emplace_back(enum_names(CaseState{})[static_cast<std::size_t>(status_[i].state)]);
  return all;
}

void SweepTable::update()
{
  std::error_code said_when_written;
  fs::create_directories(plan_.folder, said_when_written);
  // One program at a time writes the table, where the file system supports locks; others wait.
  const FileDescriptor alone(plan_.folder, O_RDONLY | O_DIRECTORY);
  ::flock(alone.number(), LOCK_EX);
  for (std::size_t i = 0; i < status_.size(); ++i)
    if (status_[i].state != CaseState::done) {
      status_[i] = status_of(plan_.cases[i], plan_.quick);
      rows_[i] = row_of(i);
    }
  std::string text = csv_header(columns());
  for (std::size_t i = 0; i < status_.size(); ++i) {
    std::string line;
    for (const std::string& word : words_of_case(i))
      line.append(line.empty() ? "" : ",").append(csv_cell(word));
    for (const auto& number : rows_[i].numbers)
      line += number && !std::isnan(number->value) ? fmt::format(",{}", number->value) : ",";
    text += line + '\n';
  }
  write_whole(plan_.folder / "sweep.csv", text);
}

std::string SweepTable::print() const
{
  std::vector<std::vector<std::string>> lines(1);
  for (const CsvColumn& column : columns())
    lines.front().push_back(csv_heading(column));
  for (std::size_t i = 0; i < status_.size(); ++i) {
    lines.push_back(words_of_case(i));
    const CaseStatus& status = status_[i];
    if (status.state == CaseState::stopped || status.state == CaseState::not_ended)
      lines.back().back() += status.goes_on_from ? fmt::format(" at t = {:.6g} s", *status.goes_on_from) : ", no checkpoint";
    for (const auto& number : rows_[i].numbers)
      lines.back().push_back(number ? fmt::format("{:.6g}", number->value) : "-");
  }
  std::string text;
  std::vector<std::size_t> widths(lines.front().size(), 0);
  for (const auto& line : lines)
    for (std::size_t c = 0; c < line.size(); ++c)
      widths[c] = std::max(widths[c], line[c].size());
  for (const auto& line : lines) {
    for (std::size_t c = 0; c < line.size(); ++c)
      text += fmt::format("{}{:>{}}", c == 0 ? "" : "  ", line[c], widths[c]);
    text += '\n';
  }
  return text;
}

std::vector<std::string> SweepTable::unknown_names() const
{
  std::vector<std::string> errors;
  for (std::size_t k = 0; k < plan_.study.collect.size(); ++k) {
    bool found = false;
    const std::vector<std::string>* known = nullptr;
    for (const Row& row : rows_) {
      found = found || (k < row.numbers.size() && row.numbers[k]);
      if (!row.known.empty())
        known = &row.known;
    }
    if (found || known == nullptr)
      continue;
    const SourceLocation& where = plan_.study.collect[k].at.where;
    const auto near = closest_match(column_of(names_[k]), *known);
    errors.push_back(fmt::format("{}: {}: no case has a number \"{}\"{}", to_string(where), where.path, names_[k],
                                 near ? fmt::format(" — did you mean \"{}\"?", *near)
                                      : "; names are the keys of summary.json, joined by points, and the columns of history.csv"));
  }
  return errors;
}

}  // namespace talus
