#pragma once
// A quantity that a run writes: one row of the tables of output fields (output_fields.hpp) and history columns (history_columns.hpp).
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// The kind of a quantity.  A moment is a scalar in 2-D, about the third axis, and a vector in 3-D.
enum class QuantityKind : std::uint8_t { number, vector, moment, symmetric, tensor };

/// Numbers per item in files of fields, where vectors in 2-D have a third component of zero.
constexpr int components_of(QuantityKind kind)
{
  using enum QuantityKind;
  return kind == number ? 1 : kind == symmetric ? 6 : kind == tensor ? 9 : 3;
}

/// A quantity.  Manual, JSON schema, checks of scenes and writers are generated from these rows.  `value` is called with data of a run and
/// returns a number, a vector, a Sym3 or a Mat3, according to the kind.  It is a generic lambda, because the types of its arguments belong
/// to folders above this one.
template <QuantityKind kind_, class Value>
struct Quantity {
  static constexpr QuantityKind kind = kind_;
  std::string_view name;     ///< in names of history columns `{}` stands for the name of the point, wall or body
  std::string_view unit;     ///< SI unit; "-" for a pure number; m^D and m^(D-1) depend on the dimension
  std::string_view meaning;  ///< description for the manual
  Value value;
};

template <QuantityKind kind, class Value>
constexpr auto quantity(std::string_view name, std::string_view unit, std::string_view meaning, Value value)
{
  return Quantity<kind, Value>{name, unit, meaning, value};
}

/// Calls f(row) for each row of a table of quantities.
template <class Table, class F>
constexpr void for_each_quantity(const Table& table, F&& f)
{
  std::apply([&](const auto&... row) { (f(row), ...); }, table);
}

template <class Table>
std::vector<std::string> names_of(const Table& table)
{
  std::vector<std::string> names;
  for_each_quantity(table, [&](const auto& row) { names.emplace_back(row.name); });
  return names;
}

template <int D, QuantityKind kind>
using ValueOf = std::conditional_t<kind == QuantityKind::number, Real,
                                   std::conditional_t<kind == QuantityKind::vector, Vec<D>,
                                                      std::conditional_t<kind == QuantityKind::moment, Vec3,
                                                                         std::conditional_t<kind == QuantityKind::symmetric, Sym3, Mat3>>>>;

/// The value in D dimensions.  A row whose lambda returns another type than its kind does not compile.
template <int D, QuantityKind kind, class Value, class... Of>
ValueOf<D, kind> value_of(const Quantity<kind, Value>& row, const Of&... of)
{
  if constexpr (kind == QuantityKind::number) {
    static_assert(std::is_arithmetic_v<std::decay_t<decltype(row.value(of...))>>);
    return static_cast<Real>(row.value(of...));
  } else {
    return row.value(of...);
  }
}

/// The unit in a dimension, where a plane has unit thickness; empty for a pure number.
inline std::string unit_in(int dimension, std::string_view unit)
{
  if (unit == "m^D")
    return dimension == 2 ? "m^2" : "m^3";
  if (unit == "m^(D-1)")
    return dimension == 2 ? "m" : "m^2";
  return unit == "-" ? "" : std::string(unit);
}

}  // namespace talus
