// Reads a motion from lines of two numbers.
#include "io/scene/record_file.hpp"

#include <fmt/format.h>

#include <charconv>
#include <optional>

#include "io/document/document.hpp"

namespace talus {

namespace {

constexpr std::string_view between_values = " \t,;";
constexpr std::size_t most_problems_of_record = 20;  // a file of another kind has an error in every line

/// The values of a line as text.
std::vector<std::string_view> values_in(std::string_view line)
{
  std::vector<std::string_view> values;
  for (std::size_t begin = line.find_first_not_of(between_values); begin != line.npos;) {
    const std::size_t end = std::min(line.find_first_of(between_values, begin), line.size());
    values.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(between_values, end);
  }
  return values;
}

std::optional<Real> number_in(std::string_view text)
{
  if (text.starts_with('+'))
    text.remove_prefix(1);
  Real value{};
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  return code == std::errc{} && end == text.data() + text.size() && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// The unit in m/s or m/s^2.
Real in_si(RecordUnit unit)
{
  constexpr Real standard_gravity = 9.80665;  // CGPM 1901
  switch (unit) {
    case RecordUnit::centimetres_per_second:
    case RecordUnit::centimetres_per_second_squared: return 0.01;
    case RecordUnit::g: return standard_gravity;
    default: return 1;
  }
}

bool is_velocity(RecordUnit unit) { return unit == RecordUnit::metres_per_second || unit == RecordUnit::centimetres_per_second; }

}  // namespace

Record read_record(const std::filesystem::path& file, const RecordOptions& spec)
{
  const std::string text = read_text(file);
  std::vector<Real> time, value;
  std::vector<SceneError> problems;
  int number = 0;
  bool heading_passed = false;
  for (const std::string_view line : lines_of(text)) {
    ++number;
    const auto complain = [&](std::string_view at, const std::string& what) {
      const int column = at.empty() ? 1 : static_cast<int>(at.data() - line.data()) + 1;
      if (problems.size() < most_problems_of_record)
        problems.push_back({{file.string(), number, column, ""}, what, shown_line(line)});
    };
    const auto values = values_in(line);
    if (values.empty() || values.front().starts_with('#'))
      continue;
    if (time.empty() && !heading_passed && problems.empty() && !number_in(values.front()) &&
        values.front().find_first_of("0123456789") != 0) {
      heading_passed = true;
      continue;
    }
    if (values.size() != 2) {
      complain(values.front(),
               fmt::format("a sample has two values, its time [s] and its value [{}]; here {} {}",
                           enum_names(spec.unit)[static_cast<std::size_t>(spec.unit)], values.size() == 1 ? "is" : "are", values.size()));
      continue;
    }
    const auto t = number_in(values[0]), v = number_in(values[1]);
    if (!t)
      complain(values[0], fmt::format("the time \"{}\" is not a finite number", values[0]));
    else if (!time.empty() && *t <= time.back())
      complain(values[0], fmt::format("the time {} s does not come after that of the sample before, {} s", *t, time.back()));
    else if (v)
      time.push_back(*t), value.push_back(*v * spec.scale * in_si(spec.unit));
    if (!v)
      complain(values[1], fmt::format("the value \"{}\" is not a finite number", values[1]));
  }
  if (problems.empty() && time.size() < 2)
    problems.push_back({{file.string(), 0, 0, ""},
                        fmt::format("a record needs two samples or more, lines of time [s] and value; there {} {}",
                                    time.size() == 1 ? "is" : "are", time.size()),
                        ""});
  if (!problems.empty())
    throw SceneErrors(problems);
  const auto integrated = is_velocity(spec.unit) ? record_of_velocity : record_of_acceleration;
  Record record = integrated(std::move(time), std::move(value));
  switch (spec.baseline) {
    case Baseline::velocity: return ends_without_velocity(std::move(record));
    case Baseline::displacement: return ends_where_it_began(std::move(record));
    case Baseline::as_recorded: break;
  }
  return record;
}

std::string describe(const RecordOptions& spec, const Record& record)
{
  return fmt::format("{}: {} samples over {:.4g} s, peaks {:.3g} m/s and {:.3g} m/s^2; ends with {:.3g} m/s, {:.3g} m from where it began",
                     spec.file, record.time.size(), record.time.back() - record.time.front(), record.peak_velocity(),
                     record.peak_acceleration(), record.velocity.back(), record.displacement());
}

}  // namespace talus
