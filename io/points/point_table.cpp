#include "io/points/point_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <string_view>

#include "io/document/document.hpp"
#include "io/files/atomic_file.hpp"
#include "io/output/vtk_points.hpp"
#include "io/points/column_names.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;
constexpr std::string_view table_blanks = " \t\r";
constexpr std::size_t most_problems_of_table = 20;

std::string_view trimmed_entry(std::string_view text)
{
  text.remove_prefix(std::min(text.find_first_not_of(table_blanks), text.size()));
  return text.substr(0, text.find_last_not_of(table_blanks) + 1);
}

/// The separator of a line: the first of semicolon, tab and comma that occurs; otherwise table_blanks.
char separator_of(std::string_view line)
{
  for (const char c : {';', '\t', ','})
    if (line.find(c) != line.npos)
      return c;
  return ' ';
}

std::vector<std::string> entries_of(std::string_view line, char separator)
{
  std::vector<std::string> entries;
  line = separator == ' ' ? trimmed_entry(line) : line;
  std::string entry;
  bool quoted = false;
  const auto end = [&] {
    if (separator != ' ' || !entry.empty())
      entries.emplace_back(trimmed_entry(entry));
    entry.clear();
  };
  for (const char c : line) {
    if (c == '"')
      quoted = !quoted;
    else if (!quoted && (c == separator || (separator == ' ' && c == '\t')))
      end();
    else
      entry += c;
  }
  end();
  return entries;
}

std::optional<Real> number_in_entry(std::string_view text)
{
  if (text.starts_with('+'))
    text.remove_prefix(1);
  Real value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// Splits "stress_xx [kPa]" or "stress_xx (kPa)" into name and unit.
PointColumn heading_column(const std::string& heading)
{
  PointColumn column;
  for (const auto& [open, close] : {std::pair('[', ']'), std::pair('(', ')')})
    if (const auto at = heading.rfind(open); at != heading.npos && at > 0 && heading.ends_with(close)) {
      column.name = trimmed_entry(std::string_view(heading).substr(0, at));
      column.unit = trimmed_entry(std::string_view(heading).substr(at + 1, heading.size() - at - 2));
      return column;
    }
  column.name = heading;
  return column;
}

PointFile read_text_table(const fs::path& file)
{
  const std::string text = plain_text(file, read_whole(file));
  PointFile table{.file = file, .columns = {}, .line = {}, .heading = 0};
  std::vector<SceneError> problems;
  char separator = ' ';
  int number = 0;
  for (const std::string_view whole : lines_of(text)) {
    ++number;
    const std::string_view line = trimmed_entry(whole);
    if (line.empty() || line.starts_with('#'))
      continue;
    if (table.columns.empty()) {
      separator = separator_of(line);
      for (const std::string& heading : entries_of(line, separator))
        table.columns.push_back(heading_column(heading));
      table.heading = number;
      if (std::ranges::all_of(table.columns, [](const PointColumn& column) { return number_in_entry(column.name).has_value(); }))
        throw SceneErrors(
            {{{file.string(), number, 1, ""}, "a line of names is needed before the numbers: x, y, stress_xx, ...", shown_line(line)}});
      continue;
    }
    const std::vector<std::string> entries = entries_of(whole, separator);
    if (entries.size() != table.columns.size()) {
      if (problems.size() < most_problems_of_table)
        problems.push_back(
            {{file.string(), number, 1, ""},
             fmt::format("there are {} entries, and {} names in line {}", entries.size(), table.columns.size(), table.heading),
             shown_line(whole)});
      continue;
    }
    for (std::size_t c = 0; c < entries.size(); ++c) {
      const auto value = number_in_entry(entries[c]);
      if (!value)
        table.columns[c].words[table.line.size()] = entries[c];
      table.columns[c].values.push_back(value.value_or(std::numeric_limits<Real>::quiet_NaN()));
    }
    table.line.push_back(number);
  }
  if (problems.empty() && table.columns.empty())
    problems.push_back({{file.string(), 0, 0, ""}, "there is nothing in it", ""});
  if (!problems.empty())
    throw SceneErrors(std::move(problems));
  return table;
}

/// The endings of the components of a field without names of its own.
std::vector<std::string> endings_of(const VtkField& field)
{
  if (!field.component_names.empty())
    return field.component_names;
  std::vector<std::string> endings;
  switch (field.components) {
    case 1: return {""};
    case 2: return {"x", "y"};
    case 3: return {"x", "y", "z"};
    case 4: return {"xx", "yy", "zz", "xy"};
    case 6: return {"xx", "yy", "zz", "xy", "yz", "xz"};
    case 9: return {"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"};
    default: break;
  }
  for (int c = 0; c < field.components; ++c)
    endings.push_back(std::to_string(c));
  return endings;
}

void add_column(PointFile& table, std::string name, std::string unit, std::span<const Real> values, std::size_t width, std::size_t first)
{
  PointColumn& column = table.columns.emplace_back(PointColumn{std::move(name), std::move(unit), {}, {}});
  column.values.reserve(values.size() / width);
  for (std::size_t i = first; i < values.size(); i += width) {
    if (!std::isfinite(values[i]))
      column.words[column.values.size()] = fmt::format("{}", values[i]);
    column.values.push_back(values[i]);
  }
}

/// The names of the columns that a field becomes.
std::vector<std::string> column_names_of(const VtkField& field)
{
  std::vector<std::string> names = endings_of(field);
  for (std::string& name : names)
    name = name.empty() ? field.name : field.name + "_" + name;
  return names;
}

bool has_stress(const std::vector<VtkField>& fields)
{
  std::vector<std::string> names;
  for (const VtkField& field : fields)
    std::ranges::move(column_names_of(field), std::back_inserter(names));
  return std::ranges::any_of(meanings_of(names), &ColumnMeaning::is_stress);
}

PointFile read_vtk_table(const fs::path& file, PointsOf data)
{
  const VtkPoints from = read_vtk_points(file);
  const bool cells = data == PointsOf::cells || (data == PointsOf::automatic && !has_stress(from.of_points) && has_stress(from.of_cells));
  const std::vector<Real>& places = cells ? from.cells : from.points;
  PointFile table{.file = file, .columns = {}, .line = {}, .heading = 0};
  for (std::size_t d = 0; d < 3; ++d)
    add_column(table, std::string(1, "xyz"[d]), "m", places, 3, d);
  for (const VtkField& field : cells ? from.of_cells : from.of_points) {
    const std::vector<std::string> names = column_names_of(field);
    for (std::size_t c = 0; c < names.size(); ++c)
      add_column(table, names[c], field.unit, field.values, names.size(), c);
  }
  return table;
}

}  // namespace

SourceLocation PointFile::where(std::size_t row) const { return {file.string(), line.empty() ? 0 : line[row], line.empty() ? 0 : 1, ""}; }
std::string PointFile::named(std::size_t row) const { return line.empty() ? fmt::format("point {}: ", row) : std::string(); }

PointFile read_point_table(const fs::path& file, PointsOf data)
{
  if (std::error_code unknown; !fs::exists(file, unknown))
    throw EnvironmentError(fmt::format("there is no file {}", file.string()));
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  static constexpr std::array<std::string_view, 7> other{".vtk", ".pvtu", ".pvd", ".vtm", ".h5", ".vti", ".xdmf"};
  if (std::ranges::find(other, ending) != other.end())
    throw EnvironmentError(fmt::format("{} cannot be read: tables are texts with a heading (.csv), or .vtu or .vtp of VTK", file.string()));
  return ending == ".vtu" || ending == ".vtp" ? read_vtk_table(file, data) : read_text_table(file);
}

}  // namespace talus
