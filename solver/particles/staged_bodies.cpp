#include "solver/particles/staged_bodies.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cstring>

#include "core/parallel/exact_sum.hpp"
#include "solver/particles/removal.hpp"

namespace talus {

namespace {

/// The arriving rows of one column.
struct Coming {
  const std::byte* rows;
  std::size_t count;
};

/// The rows of each body, those that were there and behind them those that come.
template <class Column>
void interleave(const Column& there, const std::byte* coming, const std::vector<Body>& bodies, const std::vector<Body>& of_crowd,
                Column& all)
{
  constexpr std::size_t size = row_bytes<Column>;
  auto* to = reinterpret_cast<std::byte*>(numbers_of(all, 0));
  const auto* from = reinterpret_cast<const std::byte*>(numbers_of(there, 0));
  const auto append = [&](const std::byte* rows, const Body& body) {
    const std::size_t bytes = size * static_cast<std::size_t>(body.size());
    if (bytes > 0)
      std::memcpy(to, rows + size * static_cast<std::size_t>(body.begin), bytes);
    to += bytes;
  };
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    append(from, bodies[b]);
    append(coming, of_crowd[b]);
  }
}

}  // namespace

template <int D>
ParticleSet<D> extract_bodies(std::span<const Index> goes, std::vector<Body>& bodies, std::vector<Material>& materials,
                              Particles<D>& particles)
{
  ParticleSet<D> out{bodies, materials, particles};
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    auto& left_behind = std::find(goes.begin(), goes.end(), static_cast<Index>(b)) == goes.end() ? out.particles.cell : particles.cell;
    std::fill(left_behind.begin() + bodies[b].begin, left_behind.begin() + bodies[b].end, none);
  }
  drop_lost(out.bodies, out.materials, out.particles);
  drop_lost(bodies, materials, particles);
  return out;
}

template <int D>
void insert_particles(ParticleSet<D> arriving, std::vector<Body>& bodies, std::vector<Material>& materials, Particles<D>& particles)
{
  assert(arriving.bodies.size() == bodies.size());
  const std::size_t come = arriving.particles.id.size(), n = particles.id.size() + come;
  if (come == 0)
    return;
  std::vector<Coming> coming;
  arriving.particles.for_each_column([&](std::string_view, std::string_view, const auto& column) {
    coming.push_back({reinterpret_cast<const std::byte*>(numbers_of(column, 0)), column.size()});
  });
  std::size_t number = 0;
  particles.for_each_column([&](std::string_view, std::string_view, auto& column) {
    const Coming& more = coming[number++];
    if (more.count == 0)
      return;
    std::decay_t<decltype(column)> all;
    all.resize(n);
    interleave(column, more.rows, bodies, arriving.bodies, all);
    column = std::move(all);
  });
  Index begin = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (arriving.bodies[b].size() > 0)  // of others the law may have changed since
      materials[b].history.append(arriving.materials[b].history);
    const Index size = bodies[b].size() + arriving.bodies[b].size();
    bodies[b].begin = begin, bodies[b].end = begin += size;
    materials[b].set_range(bodies[b]);
  }
}

template <int D>
Overlap<D> overlap(const Mesh<D>& mesh, std::span<const Real> there, std::span<const Real> coming, Communicator& ranks)
{
  constexpr Real round_off = 1e-9;
  ExactSums<Real> beyond, all;
  Overlap<D> found;
  Real most = 0;
  Index fullest = none;
  for (Index c = 0; c < mesh.n_cells(); ++c) {
    const auto i = static_cast<std::size_t>(c);
    if (coming[i] == 0)
      continue;
    all.add(coming[i]);
    const Real here = there[i] + coming[i] - mesh.volume(c);
    if (there[i] == 0 || here <= round_off * mesh.volume(c))
      continue;
    beyond.add(here);
    ++found.cells;
    if (here > most)
      most = here, fullest = c;
  }
  ranks.sum(beyond, all);
  found.volume = beyond.value(), found.coming = all.value();
  found.cells = ranks.sum(found.cells);
  const Real most_of_all = ranks.max(most);
  std::string place;
  if (fullest != none && most == most_of_all) {
    Vec<D> centre = Vec<D>::Zero();
    for (const Index n : mesh.cell(fullest))
      centre += mesh.node(n) / (D + 1);
    place = fmt::format("({:.4g})", fmt::join(centre.begin(), centre.end(), ", "));
  }
  found.place = ranks.first(place);
  return found;
}

template ParticleSet<2> extract_bodies<2>(std::span<const Index>, std::vector<Body>&, std::vector<Material>&, Particles<2>&);
template ParticleSet<3> extract_bodies<3>(std::span<const Index>, std::vector<Body>&, std::vector<Material>&, Particles<3>&);
template void insert_particles<2>(ParticleSet<2>, std::vector<Body>&, std::vector<Material>&, Particles<2>&);
template void insert_particles<3>(ParticleSet<3>, std::vector<Body>&, std::vector<Material>&, Particles<3>&);
template Overlap<2> overlap<2>(const Mesh<2>&, std::span<const Real>, std::span<const Real>, Communicator&);
template Overlap<3> overlap<3>(const Mesh<3>&, std::span<const Real>, std::span<const Real>, Communicator&);

}  // namespace talus
