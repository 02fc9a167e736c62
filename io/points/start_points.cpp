#include "io/points/start_points.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "io/points/column_names.hpp"
#include "io/points/point_table.hpp"
#include "mesh/geometry/linear_fit.hpp"

namespace talus {

namespace {

constexpr std::size_t most_problems_of_points = 20;

/// A column that is used, with the factor to SI.
struct UsedColumn {
  std::size_t column;
  Real factor;
};
using Components = std::vector<UsedColumn>;

Real factor_of(StressUnit unit) { return unit == StressUnit::Pa ? 1 : unit == StressUnit::kPa ? 1e3 : 1e6; }

/// Columns by what they mean.
class ColumnChoice {
 public:
  ColumnChoice(const StartStateSpec& spec, const PointTable& table, std::vector<SceneError>& problems)
      : spec_(spec), table_(table), problems_(problems)
  {
    for (std::size_t c = 0; c < table.columns.size(); ++c)
      if (const ColumnMeaning meaning = meaning_of(table.columns[c].name); meaning.quantity != PointQuantity::other)
        place(meaning, c);
  }

  /// The columns of these components of a quantity, if all of them are there.
  std::optional<Components> find(PointQuantity quantity, std::span<const std::size_t> components)
  {
    Components found;
    for (const std::size_t component : components) {
      const auto& column = columns_[static_cast<std::size_t>(quantity)][component];
      if (!column)
        return std::nullopt;
      found.push_back(use(*column, quantity));
    }
    return found;
  }
  bool any(PointQuantity quantity) const
  {
    return std::ranges::any_of(columns_[static_cast<std::size_t>(quantity)], [](const auto& column) { return column.has_value(); });
  }
  bool has(PointQuantity quantity, std::size_t component) const
  {
    return columns_[static_cast<std::size_t>(quantity)][component].has_value();
  }

  std::optional<std::size_t> named(const std::string& name) const
  {
    for (const bool exact : {true, false})
      for (std::size_t c = 0; c < table_.columns.size(); ++c)
        if (exact ? table_.columns[c].name == name : plain_name(table_.columns[c].name) == plain_name(name))
          return c;
    return std::nullopt;
  }
  /// A column in the unit in which it is.
  UsedColumn use_as_is(std::size_t column)
  {
    used_.insert(column);
    return {column, 1};
  }
  const std::set<std::size_t>& used() const noexcept { return used_; }
  void complain(const std::string& what)
  {
    problems_.push_back({{table_.file.string(), table_.heading, table_.heading > 0 ? 1 : 0, ""}, what, ""});
  }
  std::string all_names() const
  {
    std::vector<std::string> names;
    for (const PointColumn& column : table_.columns)
      names.push_back(column.name);
    return fmt::format("{}", fmt::join(names, ", "));
  }

 private:
  void place(const ColumnMeaning& meaning, std::size_t c)
  {
    auto& slot = columns_[static_cast<std::size_t>(meaning.quantity)][meaning.component];
    if (slot && (plain_name(table_.columns[c].name).ends_with("yx") || plain_name(table_.columns[c].name).ends_with("zy") ||
                 plain_name(table_.columns[c].name).ends_with("zx")))
      return;  // the other half of a symmetric tensor
    if (slot)
      complain(fmt::format("the columns \"{}\" and \"{}\" have one meaning: leave one out of the table", table_.columns[*slot].name,
                           table_.columns[c].name));
    else
      slot = c;
  }

  UsedColumn use(std::size_t column, PointQuantity quantity)
  {
    used_.insert(column);
    const std::string& unit = table_.columns[column].unit;
    const bool is_pressure =
        quantity == PointQuantity::stress || quantity == PointQuantity::effective_stress || quantity == PointQuantity::pore_pressure;
    Real factor = unit.empty() ? (is_pressure ? factor_of(spec_.unit) : 1) : factor_of_unit(unit, quantity);
    if (factor == 0) {
      complain(fmt::format("column \"{}\" has the unit \"{}\"; known are {}", table_.columns[column].name, unit,
                           is_pressure                           ? "Pa, kPa, MPa, GPa, N/m^2, kN/m^2, MN/m^2 and N/mm^2"
                           : quantity == PointQuantity::velocity ? "m/s, cm/s and mm/s"
                                                                 : "m, km, cm and mm"));
      factor = 1;
    }
    if ((quantity == PointQuantity::stress || quantity == PointQuantity::effective_stress) &&
        spec_.sign == StressSign::compression_positive)
      factor = -factor;
    return {column, factor};
  }

  const StartStateSpec& spec_;
  const PointTable& table_;
  std::vector<SceneError>& problems_;
  std::array<std::array<std::optional<std::size_t>, 6>, 7> columns_{};
  std::set<std::size_t> used_;
};

/// The rows that the scene selects.
std::vector<std::size_t> selected_rows(const StartStateSpec& spec, const PointTable& table, const ColumnChoice& choice,
                                       std::vector<SceneError>& problems)
{
  std::vector<std::size_t> rows;
  const auto column = spec.select ? choice.named(spec.select->column) : std::nullopt;
  if (spec.select && !column)
    problems.push_back({spec.select->where,
                        fmt::format("{} has no column \"{}\"; it has {}", table.file.string(), spec.select->column, choice.all_names()),
                        ""});
  std::set<std::string> known;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (!column) {
      rows.push_back(row);
      continue;
    }
    const PointColumn& by = table.columns[*column];
    const auto word = by.words.find(row);
    const std::string value = word != by.words.end() ? word->second : fmt::format("{}", by.values[row]);
    if (value == spec.select->value || value == spec.select->value + ".0" || value + ".0" == spec.select->value)
      rows.push_back(row);
    else if (known.size() < 10)
      known.insert(value);
  }
  if (column && rows.empty() && problems.empty())
    problems.push_back({spec.select->where,
                        fmt::format("no point of {} has \"{}\" in column \"{}\"; there {} {}", table.file.string(), spec.select->value,
                                    spec.select->column, known.size() == 1 ? "is" : "are", fmt::join(known, ", ")),
                        ""});
  return rows;
}

/// Everything that points of one place have to agree in.
std::vector<Real> values_at(const StartPoints& points, std::size_t i)
{
  std::vector<Real> values(points.stress[i].begin(), points.stress[i].end());
  if (!points.pore.empty())
    values.push_back(points.pore[i]);
  for (const auto* vectors : {&points.velocity, &points.displacement})
    if (!vectors->empty())
      values.insert(values.end(), (*vectors)[i].begin(), (*vectors)[i].end());
  for (const auto& [key, column] : points.history)
    values.push_back(column[i]);
  return values;
}

void keep_points(const std::vector<bool>& keep, StartPoints& points)
{
  const auto thin = [&](auto& column) {
    std::size_t to = 0;
    for (std::size_t i = 0; i < column.size(); ++i)
      if (keep[i])
        column[to++] = column[i];
    column.resize(to);
  };
  thin(points.x), thin(points.stress), thin(points.pore), thin(points.velocity), thin(points.displacement);
  for (auto& [key, column] : points.history)
    thin(column);
}

/// Drops points that are there already; complains of those with other values.
template <int D>
void merge_equal_points(const PointTable& table, const std::vector<std::size_t>& rows, StartPoints& points,
                        std::vector<SceneError>& problems)
{
  constexpr Real same_place = 1e-9, same_value = 1e-6;  // of the extent; of the largest value there: single precision
  constexpr Index most_at_a_place = 16;
  std::vector<Vec<D>> places;
  Vec<D> low = Vec<D>::Constant(std::numeric_limits<Real>::infinity()), high = -low;
  for (const auto& x : points.x) {
    places.push_back(Eigen::Map<const Vec<D>>(x.data()));
    low = low.cwiseMin(places.back()), high = high.cwiseMax(places.back());
  }
  const Real tolerance = same_place * (high - low).norm();
  const PointCloud<D> cloud(std::move(places));
  std::vector<bool> keep(points.x.size(), true);
  for (std::size_t i = 0; i < keep.size(); ++i)
    for (const auto& [squared, other] : cloud.nearest(cloud[static_cast<Index>(i)], most_at_a_place)) {
      const auto j = static_cast<std::size_t>(other);
      if (j >= i || squared > tolerance * tolerance || !keep[j])
        continue;
      const std::vector<Real> a = values_at(points, i), b = values_at(points, j);
      Real largest = 0, apart = 0;
      for (std::size_t k = 0; k < a.size(); ++k)
        largest = std::max({largest, std::abs(a[k]), std::abs(b[k])}), apart = std::max(apart, std::abs(a[k] - b[k]));
      keep[i] = false;
      if (apart > same_value * largest && problems.size() < most_problems_of_points)
        problems.push_back(
            {table.where(rows[i]),
             fmt::format("{}it lies where {} does, ({:.6g}), and has other values: average them, give values of cells "
                         "(data), or tell materials apart (select)",
                         table.named(rows[i]),
                         table.line.empty() ? fmt::format("point {}", rows[j]) : fmt::format("that of line {}", table.line[rows[j]]),
                         fmt::join(points.x[i].begin(), points.x[i].begin() + D, ", ")),
             ""});
      break;
    }
  points.merged = static_cast<Index>(std::ranges::count(keep, false));
  keep_points(keep, points);
}

/// Takes the columns out of the table.
class PointReader {
 public:
  PointReader(const StartStateSpec& spec, PointTable table, int dimension)
      : spec_(spec), table_(std::move(table)), dimension_(static_cast<std::size_t>(dimension)), choice_(spec, table_, problems_)
  {}

  StartPoints read(std::span<const std::string> history)
  {
    choose(history);
    rows_ = selected_rows(spec_, table_, choice_, problems_);
    if (problems_.empty())
      check_numbers();
    if (problems_.empty())
      fill();
    if (problems_.empty() && rows_.size() <= dimension_)
      problems_.push_back(
          {{table_.file.string(), 0, 0, ""},
           fmt::format("there {} {} point{}{}: {} or more are needed, not on one {}", rows_.size() == 1 ? "is" : "are", rows_.size(),
                       rows_.size() == 1 ? "" : "s", spec_.select ? " selected" : "", dimension_ + 1, dimension_ == 2 ? "line" : "plane"),
           ""});
    if (problems_.empty())
      dimension_ == 2 ? merge_equal_points<2>(table_, rows_, points_, problems_) : merge_equal_points<3>(table_, rows_, points_, problems_);
    if (!problems_.empty())
      throw SceneErrors(std::move(problems_));
    for (std::size_t c = 0; c < table_.columns.size(); ++c)
      (choice_.used().contains(c) ? points_.used : points_.unused).push_back(table_.columns[c].name);
    return std::move(points_);
  }

 private:
  void choose(std::span<const std::string> history)
  {
    static constexpr std::array<std::size_t, 6> all{0, 1, 2, 3, 4, 5};
    const std::span<const std::size_t> tensor = std::span(all).first(dimension_ == 2 ? 4 : 6), vector = std::span(all).first(dimension_);
    if (const auto x = choice_.find(PointQuantity::position, vector))
      position_ = *x;
    else
      missing(PointQuantity::position, vector, [](std::size_t c) { return std::string(1, "xyz"[c]); });
    const bool named_effective = spec_.stress != StressMeant::total && choice_.any(PointQuantity::effective_stress);
    const PointQuantity wanted = named_effective ? PointQuantity::effective_stress : PointQuantity::stress;
    points_.is_effective = named_effective || spec_.stress == StressMeant::effective;
    if (const auto stress = choice_.find(wanted, tensor))
      stress_ = *stress;
    else
      missing(wanted, tensor,
              [&](std::size_t c) { return fmt::format("{}stress_{}", named_effective ? "effective_" : "", stress_endings[c]); });
    static constexpr std::array<std::size_t, 1> scalar{0};
    pore_ = choice_.find(PointQuantity::pore_pressure, scalar).value_or(Components{});
    if (spec_.velocity == Carried::keep)
      velocity_ = choice_.find(PointQuantity::velocity, vector).value_or(Components{});
    if (spec_.displacement == Carried::keep) {
      displacement_ = choice_.find(PointQuantity::displacement, vector).value_or(Components{});
      if (displacement_.empty())
        choice_.complain(fmt::format("it has no columns of the displacement, which goes on from there (displacement: keep); it has {}",
                                     choice_.all_names()));
    }
    for (const std::string& key : history)
      if (const auto column = choice_.named(key); column && meaning_of(table_.columns[*column].name).quantity == PointQuantity::other)
        history_.emplace_back(key, choice_.use_as_is(*column));
  }

  template <class NameOf>
  void missing(PointQuantity quantity, std::span<const std::size_t> components, NameOf&& name_of)
  {
    std::vector<std::string> names;
    for (const std::size_t component : components)
      if (!choice_.has(quantity, component))
        names.push_back(name_of(component));
    choice_.complain(fmt::format(
        "column{} {} {} missing{}; there are {}", names.size() == 1 ? "" : "s", fmt::join(names, ", "), names.size() == 1 ? "is" : "are",
        names.size() == 1 && names.front().ends_with("_zz") && dimension_ == 2 ? ", the stress out of the plane" : "",
        choice_.all_names()));
  }

  void check_numbers()
  {
    for (const std::size_t row : rows_)
      for (const std::size_t c : choice_.used())
        if (const auto word = table_.columns[c].words.find(row);
            word != table_.columns[c].words.end() && problems_.size() < most_problems_of_points)
          problems_.push_back({table_.where(row),
                               fmt::format("{}{} is \"{}\", which is no finite number", table_.named(row), table_.columns[c].name,
                                           word->second.substr(0, 40)),
                               ""});
  }

  Real value(const UsedColumn& used, std::size_t row) const { return used.factor * table_.columns[used.column].values[row]; }
  void fill_vectors(const Components& from, std::vector<std::array<Real, 3>>& to) const
  {
    for (std::size_t i = 0; i < rows_.size() && !from.empty(); ++i) {
      std::array<Real, 3> vector{};
      for (std::size_t d = 0; d < from.size(); ++d)
        vector[d] = value(from[d], rows_[i]);
      to.push_back(vector);
    }
  }
  void fill()
  {
    fill_vectors(position_, points_.x);
    fill_vectors(velocity_, points_.velocity);
    fill_vectors(displacement_, points_.displacement);
    for (const std::size_t row : rows_) {
      Sym3 stress = Sym3::Zero();
      for (std::size_t c = 0; c < stress_.size(); ++c)
        stress[static_cast<Eigen::Index>(c)] = value(stress_[c], row);
      points_.stress.push_back(stress);
      if (!pore_.empty())
        points_.pore.push_back(value(pore_.front(), row));
    }
    for (const auto& [key, column] : history_) {
      std::vector<Real>& values = points_.history.emplace_back(key, std::vector<Real>{}).second;
      for (const std::size_t row : rows_)
        values.push_back(value(column, row));
    }
  }

  const StartStateSpec& spec_;
  PointTable table_;
  std::size_t dimension_;
  std::vector<SceneError> problems_;
  ColumnChoice choice_;
  std::vector<std::size_t> rows_;
  Components position_, stress_, pore_, velocity_, displacement_;
  std::vector<std::pair<std::string, UsedColumn>> history_;
  StartPoints points_;
};

}  // namespace

StartPoints read_start_points(const StartStateSpec& spec, const std::filesystem::path& file, int dimension,
                              std::span<const std::string> history)
{
  return PointReader(spec, read_point_table(file, spec.data), dimension).read(history);
}

}  // namespace talus
