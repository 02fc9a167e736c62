#include "io/terrain/point_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"

namespace talus {

namespace {

/// The next entry of a line; entries are separated by commas, semicolons and blanks, and two commas have an empty entry between them.
std::string_view take_entry(std::string_view& line)
{
  const auto skip_blanks = [&] { line.remove_prefix(std::min(line.find_first_not_of(" \t\r"), line.size())); };
  skip_blanks();
  const std::string_view entry = line.substr(0, line.find_first_of(",; \t\r"));
  line.remove_prefix(entry.size());
  skip_blanks();
  if (!line.empty() && (line.front() == ',' || line.front() == ';'))
    line.remove_prefix(1);
  return entry;
}

struct SurveyRow {
  std::array<Real, 3> point{};
  int numbers = 0;         ///< how many of the three numbers could be read
  std::string_view wrong;  ///< the entry that is not a number
  int column = 0;          ///< its column
};

std::optional<SurveyRow> row_of(std::string_view line)
{
  const std::string_view whole = line;
  line = line.substr(0, line.find('#'));
  if (line.find_first_not_of(" \t\r") == line.npos)
    return std::nullopt;
  SurveyRow row;
  for (Real& x : row.point) {
    const std::string_view entry = take_entry(line);
    const auto [end, code] = std::from_chars(entry.data(), entry.data() + entry.size(), x);
    if (entry.empty() || code != std::errc{} || end != entry.data() + entry.size() || !std::isfinite(x)) {
      row.wrong = entry;
      row.column = static_cast<int>(entry.data() - whole.data()) + 1;
      return row;
    }
    ++row.numbers;
  }
  return row;
}

/// Positions along one axis with equal distances, of which some may be missing.
struct PointRows {
  Real first = 0, step = 0;
  Index count = 1;
};
std::optional<PointRows> ladder_of(std::vector<Real> places)
{
  constexpr Real same = 1e-3;  // relative to the step: coordinates are written with few digits
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  Real step = std::numeric_limits<Real>::infinity();
  for (std::size_t i = 1; i < places.size(); ++i)
    step = std::min(step, places[i] - places[i - 1]);
  if (places.size() < 2)
    return std::nullopt;
  const Real steps = std::round((places.back() - places.front()) / step);
  if (!(steps < 1e6))
    return std::nullopt;
  PointRows ladder{places.front(), (places.back() - places.front()) / steps, static_cast<Index>(steps) + 1};
  for (const Real place : places)
    if (const Real at = (place - ladder.first) / ladder.step; std::abs(at - std::round(at)) > same)
      return std::nullopt;
  return ladder;
}

std::vector<Real> coordinates(const std::vector<std::array<Real, 3>>& points, std::size_t axis)
{
  std::vector<Real> all(points.size());
  std::transform(points.begin(), points.end(), all.begin(), [axis](const auto& point) { return point[axis]; });
  return all;
}

}  // namespace

std::vector<std::array<Real, 3>> read_points(const std::filesystem::path& file)
{
  const std::string bytes = read_whole(file);
  std::string_view text = bytes;
  if (text.starts_with("\xEF\xBB\xBF"))  // a byte order mark
    text.remove_prefix(3);
  std::vector<std::array<Real, 3>> points;
  std::vector<SceneError> problems;
  constexpr std::size_t most_problems = 5;
  bool first = true;
  for (int number = 1; !text.empty() && problems.size() < most_problems; ++number) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    const auto row = row_of(line);
    if (!row)
      continue;
    if (row->numbers == 3)
      points.push_back(row->point);
    else if (!first || row->numbers > 0)
      problems.push_back({{file.string(), number, row->column, ""},
                          row->wrong.empty() ? "a point has three numbers, x, y and z" : fmt::format("'{}' is no number", row->wrong),
                          std::string(line)});
    first = false;
  }
  if (problems.empty() && points.empty())
    problems.push_back({{file.string(), 0, 0, ""}, "there is no point in it", {}});
  if (!problems.empty())
    throw SceneErrors(problems);
  return points;
}

std::optional<Raster> as_raster(const std::vector<std::array<Real, 3>>& points)
{
  const auto x = ladder_of(coordinates(points, 0)), y = ladder_of(coordinates(points, 1));
  constexpr std::size_t sparse = 4;  // most grid positions per point
  if (!x || !y || static_cast<std::size_t>(x->count) * static_cast<std::size_t>(y->count) > sparse * points.size())
    return std::nullopt;
  Raster raster;
  raster.columns = x->count;
  raster.rows = y->count;
  raster.dx = x->step;
  raster.dy = y->step;
  raster.west = x->first - 0.5 * x->step;
  raster.south = y->first - 0.5 * y->step;
  raster.values.assign(static_cast<std::size_t>(raster.columns) * static_cast<std::size_t>(raster.rows),
                       std::numeric_limits<Real>::quiet_NaN());
  for (const auto& [east, north, z] : points) {
    Real& value = raster.at(static_cast<Index>(std::lround((east - x->first) / x->step)),
                            static_cast<Index>(std::lround((north - y->first) / y->step)));
    if (!std::isnan(value) && value != z)
      return std::nullopt;  // two elevations at one position
    value = z;
  }
  return raster;
}

}  // namespace talus
