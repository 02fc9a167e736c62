#pragma once
// Two bodies that swirl in a box, and everything that is stored of their particles.
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "materials/law_examples.hpp"
#include "tests/solver/blocks_of_particles.hpp"

namespace talus::testing {

/// Everything that is stored of a particle, as bytes, by the name of its column.
using Stored = std::map<std::string, std::vector<std::byte>>;
template <int D>
std::map<std::int64_t, Stored> particles_by_id(const Model<D>& m)
{
  std::map<std::int64_t, Stored> all;
  const auto bytes_of_numbers = [](const auto* from, std::size_t n) {
    const auto bytes = std::as_bytes(std::span(from, n));
    return std::vector<std::byte>(bytes.begin(), bytes.end());
  };
  for (std::size_t b = 0; b < m.state.bodies.size(); ++b)
    for (Index row = m.state.bodies[b].begin; row < m.state.bodies[b].end; ++row) {
      const auto p = static_cast<std::size_t>(row);
      Stored& one = all[m.state.particles.id[p]];
      m.state.particles.for_each_column([&](std::string_view name, std::string_view, const auto& column) {
        if (column.size() > 0)
          one[std::string(name)] = bytes_of_numbers(numbers_of(column, p), RowsOf<std::decay_t<decltype(column)>>::components);
      });
      const HistoryRows& history = m.state.materials[b].history;
      one["history"] = bytes_of_numbers(history.row(row - m.state.bodies[b].begin), static_cast<std::size_t>(history.width()));
      one["body"] = bytes_of_numbers(&b, 1);
    }
  return all;
}

/// The columns in which particles differ; "number" if there are not as many.
inline std::set<std::string> differences(const std::map<std::int64_t, Stored>& a, const std::map<std::int64_t, Stored>& b)
{
  std::set<std::string> names;
  if (a.size() != b.size())
    names.insert("number");
  for (const auto& [id, stored] : a)
    if (const auto other = b.find(id); other != b.end())
      for (const auto& [name, bytes] : stored)
        if (const auto same = other->second.find(name); same == other->second.end() || same->second != bytes)
          names.insert(name);
  return names;
}
inline const std::set<std::string> none_differ;

/// Two bodies, one with pore water, that swirl in a closed box, fast enough to change cells in each step.
template <int D, class K = Projected<D>>
Model<D> swirl(TransferOptions transfer, Index cells = 6, OnExit policy = OnExit::stop, const std::function<void(Model<D>&)>& with = {})
{
  auto m = make_model<K>(unit_box<D>(cells, 0.2));
  const auto turn = [](const Vec<D>& x) {
    Vec<D> v = Vec<D>::Zero();
    v[0] = 25 * (0.5 - x[1]), v[1] = 25 * (x[0] - 0.5);
    return v;
  };
  add_body<D>(
      m, "rubber", rubber(1e6, 0.3, 1000), D + 1, [](const Vec<D>& x) { return x[0] < 0.5; }, turn);
  add_body<D>(
      m, "soil", law_example<DruckerPrager>(), D == 2 ? 6 : 8, [](const Vec<D>& x) { return x[0] > 0.5 && x[1] < 0.8; }, turn);
  m.state.particles.x0 = m.state.particles.x;
  m.state.materials[0].viscosity = BulkViscosity{};
  for (Index n = 0; n < m.problem.mesh.n_nodes(); ++n)
    m.problem.water.table.push_back(0.6 + 0.3 * m.problem.mesh.node(n)[0]);
  m.problem.water.drained = {0, 1}, m.problem.water.unit_weight = 1e4, m.problem.water.suction = 1e3;
  m.problem.transfer = transfer;
  m.problem.exits.policy = policy;
  if (policy == OnExit::stop)
    for (const char* side : {"x_min", "x_max", "y_min", "y_max"})
      close_off<D>(m, side, Roller<D>{});
  if (with)
    with(m);
  make_ready(m);
  return m;
}

constexpr Real swirl_dt = 2e-4;  ///< a time step for it [s]

}  // namespace talus::testing
