#include "io/points/start_points.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "io/points/column_choice.hpp"
#include "io/points/equal_points.hpp"
#include "io/points/point_table.hpp"

namespace talus {

namespace {

constexpr std::size_t most_problems_of_points = 20;

/// The rows that the scene selects.
std::vector<std::size_t> selected_rows(const StartStateSpec& spec, const PointFile& table, const ColumnChoice& choice,
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

/// Takes the columns out of the table.
class PointReader {
 public:
  PointReader(const StartStateSpec& spec, PointFile table, int dimension)
      : spec_(spec), table_(std::move(table)), dimension_(static_cast<std::size_t>(dimension)), choice_(spec, table_, problems_)
  {}

  StartPoints read(std::span<const HistoryVariable> history)
  {
    choose(history);
    rows_ = selected_rows(spec_, table_, choice_, problems_);
    if (problems_.empty())
      check_numbers();
    if (problems_.empty())
      check_symmetry();
    if (problems_.empty())
      fill();
    if (problems_.empty() && rows_.size() <= dimension_)
      problems_.push_back(
          {{table_.file.string(), 0, 0, ""},
           fmt::format("there {} {} point{}{}: {} or more are needed, not on one {}", rows_.size() == 1 ? "is" : "are", rows_.size(),
                       rows_.size() == 1 ? "" : "s", spec_.select ? " selected" : "", dimension_ + 1, dimension_ == 2 ? "line" : "plane"),
           ""});
    if (problems_.empty())
      merge_equal_points(table_, rows_, static_cast<int>(dimension_), points_, problems_);
    if (!problems_.empty())
      throw SceneErrors(std::move(problems_));
    for (std::size_t c = 0; c < table_.columns.size(); ++c)
      (choice_.used().contains(c) ? points_.used : points_.unused).push_back(table_.columns[c].name);
    return std::move(points_);
  }

 private:
  void choose(std::span<const HistoryVariable> history)
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
    pore_ = choice_.find(PointQuantity::pore_pressure, scalar).value_or(UsedColumns{});
    if (spec_.velocity == Carried::keep)
      velocity_ = choice_.find(PointQuantity::velocity, vector).value_or(UsedColumns{});
    if (spec_.displacement == Carried::keep) {
      displacement_ = choice_.find(PointQuantity::displacement, vector).value_or(UsedColumns{});
      if (displacement_.empty())
        choice_.complain(fmt::format("it has no columns of the displacement, which goes on from there (displacement: keep); it has {}",
                                     choice_.all_names()));
    }
    for (const HistoryVariable& variable : history)
      if (const auto column = choice_.named(std::string(variable.key)); column && choice_.meaning(*column).quantity == PointQuantity::other)
        history_.emplace_back(variable.key, choice_.use_as(*column, variable.unit));
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

  /// A tensor with nine numbers has each shear stress twice.
  void check_symmetry()
  {
    constexpr Real rounding = 1e-6;  // of the largest stress: single precision
    Real largest = 0;
    for (const std::size_t row : rows_)
      for (const UsedColumn& used : stress_)
        largest = std::max(largest, std::abs(value(used, row)));
    for (const auto& half : choice_.halves()) {
      const UsedColumn &one = half.first, &other = half.second;
      const auto apart = [&](std::size_t row) { return std::abs(value(one, row) - value(other, row)) > rounding * largest; };
      const auto first = std::ranges::find_if(rows_, apart);
      if (first == rows_.end())
        continue;
      const PointColumn &a = table_.columns[one.column], &b = table_.columns[other.column];
      problems_.push_back(
          {table_.where(*first),
           fmt::format("{}{} is {:.6g} and {} is {:.6g}, in all at {} of {} points: a tensor of stress is symmetric", table_.named(*first),
                       a.name, a.values[*first], b.name, b.values[*first], std::ranges::count_if(rows_, apart), rows_.size()),
           ""});
    }
  }

  Real value(const UsedColumn& used, std::size_t row) const { return used.factor * table_.columns[used.column].values[row]; }
  void fill_vectors(const UsedColumns& from, std::vector<std::array<Real, 3>>& to) const
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
  PointFile table_;
  std::size_t dimension_;
  std::vector<SceneError> problems_;
  ColumnChoice choice_;
  std::vector<std::size_t> rows_;
  UsedColumns position_, stress_, pore_, velocity_, displacement_;
  std::vector<std::pair<std::string, UsedColumn>> history_;
  StartPoints points_;
};

}  // namespace

StartPoints read_start_points(const StartStateSpec& spec, const std::filesystem::path& file, int dimension,
                              std::span<const HistoryVariable> history)
{
  return PointReader(spec, read_point_table(file, spec.data), dimension).read(history);
}

}  // namespace talus
