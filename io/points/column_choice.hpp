#pragma once
// The columns of a table of points by what they mean.
#include <array>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "io/points/column_names.hpp"
#include "io/points/point_table.hpp"

namespace talus {

/// A column that is used, with the factor to SI.
struct UsedColumn {
  std::size_t column;
  Real factor;
};
using UsedColumns = std::vector<UsedColumn>;

/// Finds columns, and complains of those with one meaning and of units that are not known.
class ColumnChoice {
 public:
  /// `table` and `problems` must stay.
  ColumnChoice(const StartStateSpec& spec, const PointFile& table, std::vector<SceneError>& problems);

  /// The columns of these components of a quantity, if all of them are there.
  std::optional<UsedColumns> find(PointQuantity quantity, std::span<const std::size_t> components);
  bool any(PointQuantity quantity) const;
  bool has(PointQuantity quantity, std::size_t component) const { return columns_[number_of(quantity)][component].has_value(); }
  std::optional<std::size_t> named(const std::string& name) const;
  const ColumnMeaning& meaning(std::size_t column) const { return meanings_[column]; }
  /// A column of a history variable with that unit; without a unit of its own it has this one.
  UsedColumn use_as(std::size_t column, std::string_view unit);

  const std::set<std::size_t>& used() const noexcept { return used_; }
  /// Columns of a tensor in use that have to be equal: xy and yx.
  const std::vector<std::pair<UsedColumn, UsedColumn>>& halves() const noexcept { return halves_; }
  /// About the line of the names.
  void complain(const std::string& what);
  std::string all_names() const;

 private:
  using OfComponents = std::array<std::optional<std::size_t>, 6>;
  static std::size_t number_of(PointQuantity quantity) noexcept { return static_cast<std::size_t>(quantity); }
  void place(const ColumnMeaning& meaning, std::size_t column);
  UsedColumn use(std::size_t column, PointQuantity quantity);

  const StartStateSpec& spec_;
  const PointFile& table_;
  std::vector<SceneError>& problems_;
  std::vector<ColumnMeaning> meanings_;
  std::array<OfComponents, 7> columns_{}, mirrored_{};
  std::set<std::size_t> used_;
  std::vector<std::pair<UsedColumn, UsedColumn>> halves_;
};

}  // namespace talus
