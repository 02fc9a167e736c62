#include "app/observers/output_fields.hpp"

#include <algorithm>
#include <numeric>

namespace talus {

namespace {

/// A column of numbers, vectors or tensors out of f(row).
template <class F>
Column column_of(std::string_view name, std::string_view unit, int components, std::span<const Index> rows, F&& f)
{
  Column column{std::string(name), components, {}, unit == "-" ? "" : std::string(unit)};
  const auto width = static_cast<std::size_t>(components);
  column.values.resize(width * rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    f(static_cast<std::size_t>(rows[i]), std::span(column.values).subspan(i * width, width));
  return column;
}

template <class F>
Column scalars(std::string_view name, std::string_view unit, std::span<const Index> rows, F&& f)
{
  return column_of(name, unit, 1, rows, [&](std::size_t row, std::span<float> out) { out[0] = static_cast<float>(f(row)); });
}

/// f(row) is a vector or a matrix of any size; in 2-D the third components are zero.
template <int D, class F>
Column vectors(std::string_view name, std::string_view unit, std::span<const Index> rows, F&& f)
{
  return column_of(name, unit, 3, rows, [&](std::size_t row, std::span<float> out) {
    const Vec<D> v = f(row);
    for (int d = 0; d < D; ++d)
      out[static_cast<std::size_t>(d)] = static_cast<float>(v[d]);
  });
}
template <class F>
Column tensors(std::string_view name, std::string_view unit, std::span<const Index> rows, F&& f)
{
  return column_of(name, unit, 9, rows, [&](std::size_t row, std::span<float> out) {
    const Mat3 a = f(row);
    for (int i = 0; i < 9; ++i)
      out[static_cast<std::size_t>(i)] = static_cast<float>(a(i / 3, i % 3));
  });
}

template <int D>
Column history_column(const State<D>& state, std::span<const Index> rows, std::string_view name)
{
  Column column{std::string(name), 1, {}, ""};
  const auto each = [&](auto&& f) {
    for (std::size_t b = 0; b < state.materials.size(); ++b)
      for_each_history(state.materials[b], [&](std::string_view key, std::string_view unit, std::string_view, const auto& history) {
        if (key == name)
          f(b, unit, history);
      });
  };
  each([&](std::size_t, std::string_view unit, const auto& history) {
    column.components = std::decay_t<decltype(history)>::components;
    column.unit = unit == "-" ? "" : unit;
  });
  const auto width = static_cast<std::size_t>(column.components);
  column.values.assign(width * rows.size(), 0);
  each([&](std::size_t b, std::string_view, const auto& history) {
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (body_of(state.bodies, rows[i]) == b)
        for (std::size_t k = 0; k < width; ++k)
          column.values[i * width + k] = static_cast<float>(history.component(rows[i] - state.bodies[b].begin, static_cast<int>(k)));
  });
  return column;
}

}  // namespace

std::vector<std::string> particle_fields_of(const OutputSpec& outputs)
{
  std::vector<std::string> fields = outputs.particles->fields_wanted;
  const std::string of_picture = outputs.picture.field.substr(0, outputs.picture.field.find(':'));
  for (const std::string& name : {of_picture, std::string("body"), std::string("volume")})  // the last two: talus surface
    if (std::find(fields.begin(), fields.end(), name) == fields.end())
      fields.push_back(name);
  return fields;
}

template <int D>
Column particle_column(const State<D>& state, std::span<const Index> rows, std::string_view name)
{
  const Particles<D>& p = state.particles;
  if (name == "velocity")
    return vectors<D>(name, "m/s", rows, [&](std::size_t r) { return p.v[r]; });
  if (name == "displacement")
    return vectors<D>(name, "m", rows, [&](std::size_t r) { return Vec<D>(p.x[r] - p.x0[r]); });
  if (name == "stress")
    return column_of(name, "Pa", 6, rows, [&](std::size_t r, std::span<float> out) {
      for (int k = 0; k < 6; ++k)
        out[static_cast<std::size_t>(k)] = static_cast<float>(p.stress[r][k]);
    });
  if (name == "effective_stress")
    return column_of(name, "Pa", 6, rows, [&](std::size_t r, std::span<float> out) {
      const Sym3 stress = p.pore.empty() ? Sym3(p.stress[r]) : add_diagonal(p.stress[r], p.pore[r]);
      for (int k = 0; k < 6; ++k)
        out[static_cast<std::size_t>(k)] = static_cast<float>(stress[k]);
    });
  if (name == "pore_pressure")
    return scalars(name, "Pa", rows, [&](std::size_t r) { return p.pore.empty() ? Real{0} : Real{p.pore[r]}; });
  if (name == "pressure")
    return scalars(name, "Pa", rows, [&](std::size_t r) { return -(p.stress[r][0] + p.stress[r][1] + p.stress[r][2]) / 3; });
  if (name == "von_mises")
    return scalars(name, "Pa", rows, [&](std::size_t r) { return von_mises(unpack(p.stress[r])); });
  if (name == "volume")
    return scalars(name, D == 2 ? "m^2" : "m^3", rows, [&](std::size_t r) { return p.F[r].determinant() * p.volume0[r]; });
  if (name == "mass")
    return scalars(name, "kg", rows, [&](std::size_t r) { return p.mass[r]; });
  if (name == "cell")
    return scalars(name, "", rows, [&](std::size_t r) { return p.cell[r]; });
  if (name == "body")
    return scalars(name, "", rows, [&](std::size_t r) { return body_of(state.bodies, static_cast<Index>(r)); });
  if (name == "F")
    return tensors(name, "", rows, [&](std::size_t r) { return p.F[r]; });
  if (name == "velocity_gradient")
    return tensors(name, "1/s", rows, [&](std::size_t r) { return embed(p.L[r]); });
  return history_column(state, rows, name);
}

template <int D>
Column node_column(const RunView<D>& view, std::string_view name)
{
  const Nodes<D>& nodes = view.nodes;
  std::vector<Index> rows(nodes.sum.size());
  std::iota(rows.begin(), rows.end(), Index{0});
  if (name == "mass")
    return scalars(name, "kg", rows, [&](std::size_t n) { return nodes.sum[n].mass; });
  if (name == "velocity")
    return vectors<D>(name, "m/s", rows, [&](std::size_t n) { return nodes.motion[n].v; });
  if (name == "force")
    return vectors<D>(name, "N", rows, [&](std::size_t n) { return nodes.sum[n].force; });
  // What changed the node's momentum besides forces and gravity; nodes under a wall are not damped.
  return vectors<D>(name, "N", rows, [&](std::size_t n) {
    const NodeSum<D>& sum = nodes.sum[n];
    if (nodes.active[n] == 0 || nodes.bound[n] == 0 || nodes.kick == 0)
      return Vec<D>(Vec<D>::Zero());
    return Vec<D>(sum.mass * (nodes.motion[n].change / nodes.kick - nodes.gravity) - sum.force);
  });
}

template <int D>
std::vector<Index> rows_by_id(const Particles<D>& particles)
{
  std::vector<Index> rows(particles.id.size());
  std::iota(rows.begin(), rows.end(), Index{0});
  std::sort(rows.begin(), rows.end(),
            [&](Index a, Index b) { return particles.id[static_cast<std::size_t>(a)] < particles.id[static_cast<std::size_t>(b)]; });
  return rows;
}

template <int D>
std::vector<Real> positions(const Particles<D>& particles, std::span<const Index> rows)
{
  std::vector<Real> places(3 * rows.size(), 0.0);
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t d = 0; d < D; ++d)
      places[3 * i + d] = particles.x[static_cast<std::size_t>(rows[i])][static_cast<Index>(d)];
  return places;
}

template Column particle_column<2>(const State<2>&, std::span<const Index>, std::string_view);
template Column particle_column<3>(const State<3>&, std::span<const Index>, std::string_view);
template Column node_column<2>(const RunView<2>&, std::string_view);
template Column node_column<3>(const RunView<3>&, std::string_view);
template std::vector<Index> rows_by_id<2>(const Particles<2>&);
template std::vector<Index> rows_by_id<3>(const Particles<3>&);
template std::vector<Real> positions<2>(const Particles<2>&, std::span<const Index>);
template std::vector<Real> positions<3>(const Particles<3>&, std::span<const Index>);

}  // namespace talus
