#include "app/observers/field_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "core/field_component.hpp"
#include "core/parallel/parallel_sort.hpp"
#include "core/parallel/threads.hpp"
#include "io/output/output_fields.hpp"
#include "materials/interface/any_law.hpp"
#include "materials/interface/varied_law.hpp"
#include "solver/model/seepage.hpp"

namespace talus {

namespace {

void put(Real value, std::span<float> out) { out[0] = static_cast<float>(value); }
void put(const Mat3& value, std::span<float> out)
{
  for (int i = 0; i < 9; ++i)
    out[static_cast<std::size_t>(i)] = static_cast<float>(value(i / 3, i % 3));
}
/// Vectors of two dimensions leave the third component 0.
template <int N>
void put(const Vec<N>& value, std::span<float> out)
{
  for (int d = 0; d < N; ++d)
    out[static_cast<std::size_t>(d)] = static_cast<float>(value[d]);
}

/// A row of the tables of io/output/output_fields.hpp, for these rows of the particles or nodes of `of`.
template <int D, class Of, QuantityKind kind, class Value>
Column column_of(const Quantity<kind, Value>& field, const Of& of, std::span<const Index> rows)
{
  constexpr auto width = static_cast<std::size_t>(components_of(kind));
  Column column{std::string(field.name), components_of(kind), std::vector<float>(width * rows.size()), unit_in(D, field.unit)};
  parallel_for(static_cast<Index>(rows.size()), [&](Index number) {
    const auto i = static_cast<std::size_t>(number);
    put(value_of<D>(field, of, static_cast<std::size_t>(rows[i])), std::span(column.values).subspan(i * width, width));
  });
  return column;
}

template <int D, class Table, class Of>
std::optional<Column> column_of_table(const Table& table, std::string_view name, const Of& of, std::span<const Index> rows)
{
  std::optional<Column> column;
  for_each_quantity(table, [&](const auto& field) {
    if (field.name == name)
      column = column_of<D>(field, of, rows);
  });
  return column;
}

/// The checks of scenes let no other name through.
[[noreturn]] void no_such_field(std::string_view name) { throw std::invalid_argument(fmt::format("there is no field \"{}\"", name)); }

/// Of any law of the run, which need not be that of a body yet: stages change materials.  All laws give a variable one kind and unit.
template <int D>
Column history_column(const Problem<D>& problem, const State<D>& state, std::span<const Index> rows, std::string_view name)
{
  Column column{std::string(name), 0, {}, ""};
  std::vector<const LawDescription*> laws = known_laws();
  for (const auto& law : problem.laws_of_user)
    laws.push_back(&law->description());
  for (const LawDescription* law : laws)
    for (const HistoryVariable& variable : law->variables)
      if (variable.key == name)
        column.components = variable.components, column.unit = unit_in(D, variable.unit);
  if (column.components == 0 && is_name_of_factor(name))
    column.components = 1, column.unit = "-";
  if (column.components == 0)
    no_such_field(name);
  const auto width = static_cast<std::size_t>(column.components);
  column.values.assign(width * rows.size(), 0);
  for (std::size_t b = 0; b < state.materials.size(); ++b)
    for (const HistoryVariable& variable : state.materials[b].law().variables()) {
      if (variable.key != name)
        continue;
      for (std::size_t i = 0; i < rows.size(); ++i)
        if (body_of(state.bodies, rows[i]) == b)
          for (std::size_t k = 0; k < width; ++k)
            column.values[i * width + k] =
                static_cast<float>(history_value(state.materials[b], variable, rows[i] - state.bodies[b].begin, static_cast<int>(k)));
    }
  return column;
}

}  // namespace

std::vector<std::string> particle_fields_of(const OutputSpec& outputs)
{
  std::vector<std::string> fields = outputs.particles->fields_wanted;
  const std::string of_picture = ViewedField::of(outputs.picture.field).name;
  for (const std::string& name : {of_picture, std::string("body"), std::string("volume")})  // the last two: talus surface
    if (std::find(fields.begin(), fields.end(), name) == fields.end())
      fields.push_back(name);
  return fields;
}

template <int D>
Column particle_column(const Problem<D>& problem, const State<D>& state, std::span<const Index> rows, std::string_view name)
{
  struct {
    const Problem<D>& problem;
    const State<D>& state;
  } const of{problem, state};
  std::optional<Column> column = column_of_table<D>(particle_fields(), name, of, rows);
  return column ? *std::move(column) : history_column(problem, state, rows, name);
}

template <int D>
Column node_column(const RunView<D>& view, std::string_view name)
{
  std::vector<Index> rows(view.fields.front().nodes.sum.size());
  std::iota(rows.begin(), rows.end(), Index{0});
  std::optional<Column> column = column_of_table<D>(node_fields(), name, view, rows);
  return column ? *std::move(column) : (no_such_field(name), Column{});
}

template <int D>
std::vector<Index> rows_by_id(const Particles<D>& particles)
{
  std::vector<std::pair<std::int64_t, Index>> id_and_row(particles.id.size());
  for (std::size_t row = 0; row < id_and_row.size(); ++row)
    id_and_row[row] = {particles.id[row], static_cast<Index>(row)};
  parallel_sort(id_and_row);
  std::vector<Index> rows(id_and_row.size());
  std::ranges::transform(id_and_row, rows.begin(), &std::pair<std::int64_t, Index>::second);
  return rows;
}

template <int D>
std::vector<Real> positions(const Particles<D>& particles, std::span<const Index> rows)
{
  std::vector<Real> places(3 * rows.size(), 0.0);
  parallel_for(static_cast<Index>(rows.size()), [&](Index number) {
    const auto i = static_cast<std::size_t>(number);
    for (std::size_t d = 0; d < D; ++d)
      places[3 * i + d] = particles.x[static_cast<std::size_t>(rows[i])][static_cast<Index>(d)];
  });
  return places;
}

template Column particle_column<2>(const Problem<2>&, const State<2>&, std::span<const Index>, std::string_view);
template Column particle_column<3>(const Problem<3>&, const State<3>&, std::span<const Index>, std::string_view);
template Column node_column<2>(const RunView<2>&, std::string_view);
template Column node_column<3>(const RunView<3>&, std::string_view);
template std::vector<Index> rows_by_id<2>(const Particles<2>&);
template std::vector<Index> rows_by_id<3>(const Particles<3>&);
template std::vector<Real> positions<2>(const Particles<2>&, std::span<const Index>);
template std::vector<Real> positions<3>(const Particles<3>&, std::span<const Index>);

}  // namespace talus
