#include "io/points/column_choice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace talus {

namespace {

Real factor_of(StressUnit unit) { return unit == StressUnit::Pa ? 1 : unit == StressUnit::kPa ? 1e3 : 1e6; }

}  // namespace

ColumnChoice::ColumnChoice(const StartStateSpec& spec, const PointFile& table, std::vector<SceneError>& problems)
    : spec_(spec), table_(table), problems_(problems)
{
  std::vector<std::string> names;
  for (const PointColumn& column : table.columns)
    names.push_back(column.name);
  meanings_ = meanings_of(names);
  for (std::size_t c = 0; c < names.size(); ++c)
    if (meanings_[c].quantity != PointQuantity::other)
      place(meanings_[c], c);
  for (std::size_t q = 0; q < columns_.size(); ++q)
    for (std::size_t k = 0; k < columns_[q].size(); ++k)
      if (!columns_[q][k])
        columns_[q][k] = std::exchange(mirrored_[q][k], std::nullopt);  // yx alone is as good as xy
}

std::optional<UsedColumns> ColumnChoice::find(PointQuantity quantity, std::span<const std::size_t> components)
{
  if (!std::ranges::all_of(components, [&](std::size_t component) { return has(quantity, component); }))
    return std::nullopt;
  UsedColumns found;
  for (const std::size_t component : components) {
    found.push_back(use(*columns_[number_of(quantity)][component], quantity));
    if (const auto& other = mirrored_[number_of(quantity)][component])
      halves_.emplace_back(found.back(), use(*other, quantity));
  }
  return found;
}

bool ColumnChoice::any(PointQuantity quantity) const
{
  return std::ranges::any_of(columns_[number_of(quantity)], [](const auto& column) { return column.has_value(); });
}

std::optional<std::size_t> ColumnChoice::named(const std::string& name) const
{
  for (const bool exact : {true, false})
    for (std::size_t c = 0; c < table_.columns.size(); ++c)
      if (exact ? table_.columns[c].name == name : plain_name(table_.columns[c].name) == plain_name(name))
        return c;
  return std::nullopt;
}

UsedColumn ColumnChoice::use_as(std::size_t column, std::string_view unit)
{
  used_.insert(column);
  const std::string& given = table_.columns[column].unit;
  const Real factor = given.empty() ? 1 : factor_between(given, unit);
  if (factor == 0)
    complain(fmt::format("column \"{}\" has the unit \"{}\"; known for this history variable: {}", table_.columns[column].name, given,
                         known_units_for(unit)));
  return {column, factor};
}

void ColumnChoice::complain(const std::string& what)
{
  problems_.push_back({{table_.file.string(), table_.heading, table_.heading > 0 ? 1 : 0, ""}, what, ""});
}

std::string ColumnChoice::all_names() const
{
  std::vector<std::string> names;
  for (const PointColumn& column : table_.columns)
    names.push_back(column.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

void ColumnChoice::place(const ColumnMeaning& meaning, std::size_t column)
{
  auto& slot = (meaning.mirrored ? mirrored_ : columns_)[number_of(meaning.quantity)][meaning.component];
  if (slot)
    complain(fmt::format("the columns \"{}\" and \"{}\" have one meaning: leave one out of the table", table_.columns[*slot].name,
                         table_.columns[column].name));
  else
    slot = column;
}

UsedColumn ColumnChoice::use(std::size_t column, PointQuantity quantity)
{
  used_.insert(column);
  const std::string& unit = table_.columns[column].unit;
  const bool is_stress = quantity == PointQuantity::stress || quantity == PointQuantity::effective_stress;
  const bool is_pressure = is_stress || quantity == PointQuantity::pore_pressure;
  Real factor = unit.empty() ? (is_pressure ? factor_of(spec_.unit) : 1) : factor_of_unit(unit, quantity);
  if (factor == 0) {
    const std::string_view in_si = is_pressure ? "Pa" : quantity == PointQuantity::velocity ? "m/s" : "m";
    complain(fmt::format("column \"{}\" has the unit \"{}\"; known are {}", table_.columns[column].name, unit, known_units_for(in_si)));
    factor = 1;
  }
  return {column, is_stress && spec_.sign == StressSign::compression_positive ? -factor : factor};
}

}  // namespace talus
