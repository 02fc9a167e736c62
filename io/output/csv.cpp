// Comma-separated tables, written row by row and read back as a whole.
#include "io/output/csv.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <iterator>
#include <stdexcept>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/manifest.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

std::string row(std::span<const Real> values)
{
  std::string line;
  for (std::size_t c = 0; c < values.size(); ++c) {
    line += c == 0 ? "" : ",";
    if (!std::isnan(values[c]))
      fmt::format_to(std::back_inserter(line), "{}", values[c]);  // {}: the shortest text that gives bitwise the same number
  }
  return line + '\n';
}

std::vector<std::string> split(std::string_view line)
{
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
      cells.back() += line[++i];
    else if (line[i] == '"')
      quoted = !quoted;
    else if (line[i] == ',' && !quoted)
      cells.emplace_back();
    else
      cells.back() += line[i];
  }
  return cells;
}

/// Whether a spreadsheet would run a text, after its leading apostrophes, as a formula: it begins with =, +, - or @ and is not a number.
/// Texts may be names from the scene of another person.  csv_cell() puts an apostrophe before such a text, and one more before a text with
/// leading apostrophes, so that read_history() can remove it.
bool looks_like_formula(std::string_view text)
{
  text.remove_prefix(std::min(text.find_first_not_of('\''), text.size()));
  return !text.empty() && std::string_view("=+-@").find(text.front()) != std::string_view::npos;
}

bool is_plain_number(std::string_view text)
{
  if (text.starts_with('+'))
    text.remove_prefix(1);
  Real value{};
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  return !text.empty() && code == std::errc{} && end == text.data() + text.size();
}

CsvColumn column_of(std::string cell)
{
  if (cell.starts_with('\'') && looks_like_formula(cell))
    cell.erase(0, 1);
  const auto open = cell.rfind(" [");
  if (open == std::string::npos || cell.back() != ']')
    return {cell};
  return {cell.substr(0, open), cell.substr(open + 2, cell.size() - open - 3)};
}

Real number(const std::string& cell, const fs::path& file, std::size_t line)
{
  if (cell.empty())
    return std::numeric_limits<Real>::quiet_NaN();
  Real value{};
  const auto [end, code] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (code != std::errc{} || end != cell.data() + cell.size())
    throw EnvironmentError(fmt::format("{}:{}: \"{}\" is not a number", file.string(), line, cell));
  return value;
}

}  // namespace

std::string csv_cell(std::string text)
{
  std::replace(text.begin(), text.end(), '\n', ' ');
  if (looks_like_formula(text) && !is_plain_number(text))
    text.insert(0, 1, '\'');
  if (text.find_first_of(",\"") == std::string::npos)
    return text;
  std::string quoted = "\"";
  for (const char c : text)
    quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string csv_header(std::span<const CsvColumn> columns)
{
  std::string line;
  for (const auto& [name, unit] : columns)
    line.append(line.empty() ? "" : ",").append(csv_cell(unit.empty() ? name : fmt::format("{} [{}]", name, unit)));
  return line + '\n';
}

HistoryFile::HistoryFile(fs::path file, std::vector<CsvColumn> columns, std::string_view rows)
    : path_(std::move(file)), columns_(std::move(columns))
{
  write_whole(path_, csv_header(columns_).append(rows));
  note_result(path_, path_, Proof::grows);
  file_.reset(std::fopen(path_.c_str(), "ae"));
  if (!file_)
    throw EnvironmentError(fmt::format("cannot write {}: {}", path_.string(), std::strerror(errno)));
}

HistoryFile::HistoryFile(fs::path file, std::vector<CsvColumn> columns) : HistoryFile(std::move(file), std::move(columns), {}) {}

HistoryFile HistoryFile::resume(fs::path file, std::vector<CsvColumn> columns, Real time)
{
  std::string rows;
  Real last_time = -std::numeric_limits<Real>::infinity();
  if (std::error_code unreadable; fs::exists(file, unreadable)) {
    const HistoryTable old = read_history(file);
    if (old.columns != columns)
      throw EnvironmentError(fmt::format("{} has other columns than this run: move it away to go on", file.string()));
    std::vector<Real> values(columns.size());
    for (std::size_t r = 0; r < old.rows() && old.values[0][r] <= time; ++r) {
      for (std::size_t c = 0; c < columns.size(); ++c)
        values[c] = old.values[c][r];
      rows += row(values);
      last_time = values[0];
    }
  }
  HistoryFile history(std::move(file), std::move(columns), rows);
  history.last_time_ = last_time;
  return history;
}

void HistoryFile::append(std::span<const Real> values)
{
  if (values.size() != columns_.size())
    throw std::invalid_argument(fmt::format("{}: a row of {} values for {} columns", path_.string(), values.size(), columns_.size()));
  put(row(values));
  last_time_ = values[0];
}

void HistoryFile::flush() const
{
  if (::fsync(::fileno(file_.get())) != 0 && errno != EINVAL)  // EINVAL: not an ordinary file
    throw EnvironmentError(fmt::format("cannot write {}: {}", path_.string(), std::strerror(errno)));
}

void HistoryFile::put(std::string_view text)
{
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size() || std::fflush(file_.get()) != 0)
    throw EnvironmentError(fmt::format("cannot write {}: {}", path_.string(), std::strerror(errno)));
}

std::optional<std::span<const Real>> HistoryTable::operator[](std::string_view name) const&
{
  for (std::size_t c = 0; c < columns.size(); ++c)
    if (columns[c].name == name)
      return values[c];
  return std::nullopt;
}

HistoryTable read_history(const fs::path& file)
{
  const std::string text = read_whole(file);
  HistoryTable history;
  std::size_t line = 0, begin = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; begin = end + 1, end = text.find('\n', begin)) {
    const auto cells = split(std::string_view(text).substr(begin, end - begin));
    if (++line == 1) {
      for (const auto& cell : cells)
        history.columns.push_back(column_of(cell));
      history.values.resize(cells.size());
      continue;
    }
    if (cells.size() != history.columns.size())
      throw EnvironmentError(fmt::format("{}:{}: {} values for {} columns", file.string(), line, cells.size(), history.columns.size()));
    for (std::size_t c = 0; c < cells.size(); ++c)
      history.values[c].push_back(number(cells[c], file, line));
  }
  if (line == 0)
    throw EnvironmentError(fmt::format("{} has no header line", file.string()));
  return history;
}

}  // namespace talus
