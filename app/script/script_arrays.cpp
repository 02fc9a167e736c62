#include "app/script/script_arrays.hpp"

#include <algorithm>
#include <stdexcept>

#include "io/output/output_fields.hpp"
#include "solver/model/seepage.hpp"

namespace talus {

namespace {

constexpr auto real_bytes = static_cast<std::int64_t>(sizeof(Real));

/// The shape and strides of the values of one row, whose numbers lie side by side; matrices by columns.
template <class Value>
struct Layout {
  static void add(ScriptArray&) {}
};
template <int R, int C>
struct Layout<Eigen::Matrix<Real, R, C, Eigen::DontAlign>> {
  static void add(ScriptArray& array)
  {
    array.shape.push_back(R), array.strides.push_back(real_bytes);
    if (C > 1)
      array.shape.push_back(C), array.strides.push_back(R * real_bytes);
  }
};

struct RowRange {
  std::size_t begin, end;
  std::int64_t size() const noexcept { return static_cast<std::int64_t>(end - begin); }
};

template <class Value>
ScriptArray seen_rows(const ParticleColumn<Value>& column, RowRange rows)
{
  ScriptArray array{'d', column.row_at(rows.begin), {rows.size()}, {ParticleColumn<Value>::components * real_bytes}};
  Layout<Value>::add(array);
  return array;
}
template <class Number>
ScriptArray seen_rows(const std::vector<Number>& column, RowRange rows)
{
  return {sizeof(Number) == 8 ? 'q' : 'i', column.data() + rows.begin, {rows.size()}, {static_cast<std::int64_t>(sizeof(Number))}};
}

/// Calls f(name, column) for the columns that a script sees as they are.
template <int D, class F>
void for_each_seen_column(const Particles<D>& particles, F&& f)
{
  f("id", particles.id), f("cell", particles.cell), f("position", particles.x), f("velocity", particles.v);
  f("velocity_gradient", particles.L), f("F", particles.F), f("stress", particles.stress);
  f("mass", particles.mass), f("volume", particles.volume);
}

/// An array that owns its numbers, those of the last index side by side.
template <class Number>
ScriptArray array_of(std::vector<Number> numbers, std::vector<std::int64_t> shape)
{
  auto owner = std::make_shared<const std::vector<Number>>(std::move(numbers));
  const char letter = std::is_floating_point_v<Number> ? 'd' : 'i';
  ScriptArray array{letter, owner->data(), std::move(shape), {}, owner};
  array.strides.assign(array.shape.size(), static_cast<std::int64_t>(sizeof(Number)));
  for (std::size_t i = array.shape.size() - 1; i > 0; --i)
    array.strides[i - 1] = array.strides[i] * array.shape[i];
  return array;
}

void append_numbers(Real value, std::vector<Real>& numbers) { numbers.push_back(value); }
void append_numbers(const Mat3& value, std::vector<Real>& numbers)
{
  for (Index i = 0; i < 9; ++i)
    numbers.push_back(value(i / 3, i % 3));
}
template <int N>
void append_numbers(const Vec<N>& value, std::vector<Real>& numbers)
{
  numbers.insert(numbers.end(), value.begin(), value.end());
}

/// A row of the tables of io/output/output_fields.hpp.
template <int D, class Of, QuantityKind kind, class Value>
ScriptArray computed(const Quantity<kind, Value>& field, const Of& of, RowRange rows)
{
  std::vector<Real> numbers;
  for (std::size_t row = rows.begin; row < rows.end; ++row)
    append_numbers(value_of<D>(field, of, row), numbers);
  std::vector<std::int64_t> shape{rows.size()};
  if constexpr (kind == QuantityKind::vector)
    shape.push_back(D);
  else if constexpr (kind == QuantityKind::symmetric)
    shape.push_back(6);
  else if constexpr (kind == QuantityKind::tensor)
    shape.insert(shape.end(), {3, 3});
  return array_of(std::move(numbers), std::move(shape));
}

template <int D, class Table, class Of>
std::optional<ScriptArray> computed(const Table& table, const std::string& name, const Of& of, RowRange rows)
{
  std::optional<ScriptArray> array;
  for_each_quantity(table, [&](const auto& field) {
    if (field.name == name)
      array = computed<D>(field, of, rows);
  });
  return array;
}

const HistoryVariable* variable_of(const Material& material, const std::string& name)
{
  const auto variables = material.law().variables();
  const auto found = std::ranges::find_if(variables, [&](const HistoryVariable& one) { return one.key == name; });
  return found == variables.end() ? nullptr : &*found;
}

/// Of one body, as it is.
ScriptArray history_of_body(const Material& material, const HistoryVariable& variable)
{
  const auto n = static_cast<std::int64_t>(material.history.size()), width = static_cast<std::int64_t>(material.history.row_bytes());
  ScriptArray array{'d', material.history.row(0) + variable.first, {n}, {width}};
  if (variable.components > 1)
    array.shape.push_back(variable.components), array.strides.push_back(real_bytes);
  return array;
}

/// Of all bodies: 0 in those whose laws do not have it.
template <int D>
std::optional<ScriptArray> history_of_all(const ParticleColumns<D>& columns, const std::string& name)
{
  int components = 0;
  for (const Material& material : columns.materials)
    if (const HistoryVariable* const variable = variable_of(material, name))
      components = variable->components;
  if (components == 0)
    return std::nullopt;
  const auto width = static_cast<std::size_t>(components);
  std::vector<Real> numbers(columns.particles.id.size() * width);
  for (std::size_t b = 0; b < columns.bodies.size(); ++b)
    if (const HistoryVariable* const variable = variable_of(columns.materials[b], name))
      for (Index i = 0; i < columns.bodies[b].size(); ++i)
        std::copy_n(columns.materials[b].history.row(i) + variable->first, width,
                    numbers.data() + static_cast<std::size_t>(columns.bodies[b].begin + i) * width);
  std::vector<std::int64_t> shape{static_cast<std::int64_t>(columns.particles.id.size())};
  if (components > 1)
    shape.push_back(components);
  return array_of(std::move(numbers), std::move(shape));
}

/// What the functions of output_fields.hpp take.
template <int D>
struct ProblemAndState {
  const Problem<D>& problem;
  const State<D>& state;
};

}  // namespace

template <int D>
std::vector<std::string> names_of_particles(const RunView<D>& view, std::optional<std::size_t> body)
{
  std::vector<std::string> names;
  for_each_seen_column(view.state.particles, [&](std::string_view column, const auto&) { names.emplace_back(column); });
  const auto add = [&](std::string_view name) {
    if (std::ranges::find(names, name) == names.end())
      names.emplace_back(name);
  };
  for (std::size_t b = 0; b < view.state.materials.size(); ++b)
    if (!body || *body == b)
      for (const HistoryVariable& variable : view.state.materials[b].law().variables())
        add(variable.key);
  for_each_quantity(particle_fields(), [&](const auto& field) { add(field.name); });
  return names;
}

template <int D>
ScriptArray particles_of(const RunView<D>& view, const ParticleColumns<D>& columns, const std::string& name,
                         std::optional<std::size_t> body)
{
  RowRange rows{0, columns.particles.id.size()};
  if (body)
    rows = {to_size(columns.bodies[*body].begin), to_size(columns.bodies[*body].end)};
  std::optional<ScriptArray> array;
  for_each_seen_column(columns.particles, [&](std::string_view column, const auto& values) {
    if (column == name)
      array = seen_rows(values, rows);
  });
  if (!array && (body || columns.bodies.size() == 1))
    if (const std::size_t b = body.value_or(0); const HistoryVariable* const variable = variable_of(columns.materials[b], name))
      array = history_of_body(columns.materials[b], *variable);
  if (array) {
    array->owner = columns.owner;
    return *std::move(array);
  }
  if (!body)
    array = history_of_all(columns, name);
  if (!array)
    array = computed<D>(particle_fields(), name, ProblemAndState<D>{view.problem, view.state}, rows);
  if (!array)
    throw std::out_of_range(name);
  return *std::move(array);
}

template <int D>
std::vector<std::string> names_of_nodes()
{
  std::vector<std::string> names{"position", "cells"};
  for_each_quantity(node_fields(), [&](const auto& field) { names.emplace_back(field.name); });
  return names;
}

template <int D>
ScriptArray nodes_of(const RunView<D>& view, const std::string& name)
{
  const Mesh<D>& mesh = view.problem.mesh;
  const std::int64_t n = mesh.n_nodes();
  if (name == "position") {
    std::vector<Real> numbers;
    for (const Vec<D>& x : mesh.nodes())
      append_numbers(x, numbers);
    return array_of(std::move(numbers), {n, D});
  }
  if (name == "cells") {
    std::vector<Index> numbers;
    for (const auto& cell : mesh.cells())
      numbers.insert(numbers.end(), cell.begin(), cell.end());
    return array_of(std::move(numbers), {mesh.n_cells(), D + 1});
  }
  auto array = computed<D>(node_fields(), name, view, RowRange{0, static_cast<std::size_t>(n)});
  if (!array)
    throw std::out_of_range(name);
  return *std::move(array);
}

#define TALUS_INSTANTIATE(D)                                                                                                       \
  template std::vector<std::string> names_of_particles(const RunView<D>&, std::optional<std::size_t>);                             \
  template ScriptArray particles_of(const RunView<D>&, const ParticleColumns<D>&, const std::string&, std::optional<std::size_t>); \
  template std::vector<std::string> names_of_nodes<D>();                                                                           \
  template ScriptArray nodes_of(const RunView<D>&, const std::string&);
TALUS_INSTANTIATE(2)
TALUS_INSTANTIATE(3)
#undef TALUS_INSTANTIATE

}  // namespace talus
