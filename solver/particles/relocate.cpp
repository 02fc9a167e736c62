#include "solver/particles/relocate.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "core/particle_pack.hpp"

namespace talus {

namespace {

/// Disorder above which the arrays themselves are re-ordered: below it the gain does not pay for the move.  Measured with 400 000
/// particles that swirl: from 0.2 to 0.5 a step costs the same to 10 %, with 0.8 and without any re-ordering half as much again.
constexpr Real most_disorder = 0.4;
/// A particle set back onto a wall is placed this share of the cell's smallest altitude inside.
constexpr Real inset = 1e-6;

std::size_t z(Index i) { return static_cast<std::size_t>(i); }

/// column[i] <- column[order[i]] by way of `spare`, which is kept: room for one column.
template <class Column>
void permute(Column& column, std::span<const Index> order, std::vector<std::byte>& spare)
{
  if (column.empty())
    return;
  constexpr std::size_t bytes = row_bytes<Column>;
  spare.resize(std::max(spare.size(), column.size() * bytes));
  std::byte* const sorted = spare.data();
  const auto n = static_cast<Index>(order.size());
  parallel_for(n, [&](Index i) { save_row(column, z(order[z(i)]), sorted + z(i) * bytes); });
  parallel_for(n, [&](Index i) { load_row(sorted + z(i) * bytes, column, z(i)); });
}

}  // namespace

template <int D>
void drop_lost(std::vector<Body>& bodies, std::vector<Material>& materials, Particles<D>& particles)
{
  std::vector<std::uint8_t> stays(z(particles.size()));
  for (Index p = 0; p < particles.size(); ++p)
    stays[z(p)] = particles.cell[z(p)] != none;
  const auto squeeze = [&](auto& column, Index begin, Index end) {
    auto to = z(begin);
    for (Index p = begin; p < end; ++p)
      if (stays[z(p)])
        copy_row(column, z(p), column, to++);
    return to;
  };
  for (auto& material : materials) {
    Index to = 0;
    for (Index i = 0; i < material.size(); ++i)
      if (stays[z(material.begin + i)])
        material.history.copy_row(i, to++);
    material.history.resize(to);
  }
  const Index all = particles.size();
  particles.for_each_column([&](std::string_view, std::string_view, auto& column) {
    if (!column.empty())
      column.resize(squeeze(column, 0, all));
  });
  Index begin = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const auto count = static_cast<Index>(std::count(stays.begin() + bodies[b].begin, stays.begin() + bodies[b].end, 1));
    bodies[b].begin = begin;
    bodies[b].end = begin += count;
    materials[b].set_range(bodies[b]);
  }
}

template <int D>
RemovedParticles<D> content_of(const Vec<D>& x, const Vec<D>& v, Real mass, Real plastic_work) noexcept
{
  RemovedParticles<D> gone{.mass = mass, .count = 1};
  if (x.allFinite() && v.allFinite()) {
    gone.momentum = ForceAndMoment<D>::at(x, mass * v);
    gone.kinetic = 0.5 * mass * v.squaredNorm();
  }
  if (std::isfinite(plastic_work))
    gone.plastic = plastic_work;
  return gone;
}

template <int D>
RemovedParticles<D> content_of(const std::vector<Body>& bodies, const std::vector<Material>& materials, const Particles<D>& particles,
                               Index row)
{
  const std::size_t p = z(row);
  std::size_t body = 0;
  while (row >= bodies[body].end)
    ++body;
  return content_of<D>(particles.x[p], particles.v[p], particles.mass[p],
                       plastic_work(materials[body], row - bodies[body].begin, particles.volume0[p]));
}

template <int D>
std::optional<SetBack<D>> set_back(const Mesh<D>& mesh, const Locator<D>& locator, const Exits& exits, const Vec<D>& x) noexcept
{
  const auto nearest = locator.nearest(mesh, x);
  const Real distance = (nearest.x - x).norm();
  if ((exits.closed[z(nearest.cell)] >> nearest.facet.local & 1) == 0 || !(distance < mesh.altitude(nearest.cell)))
    return std::nullopt;
  Vec<D> centre = Vec<D>::Zero();
  for (const Index n : mesh.cell(nearest.cell))
    centre += mesh.node(n) / (D + 1);
  const Vec<D> inside = nearest.x + inset * (centre - nearest.x);
  return SetBack<D>{inside, locator(mesh, inside, nearest.cell).value_or(nearest.cell), distance};
}

namespace {

template <int D>
RemovedParticles<D> mark_deleted(const std::vector<Body>& bodies, const std::vector<Material>& materials, Particles<D>& particles,
                                 Index row)
{
  particles.cell[z(row)] = none;
  return content_of(bodies, materials, particles, row);
}

}  // namespace

template <int D>
void remove_failed(const Mesh<D>& mesh, std::vector<Body>& bodies, std::vector<Material>& materials, Particles<D>& particles,
                   CellOrder& order, ExactSums<RemovedParticles<D>>& removed)
{
  for (Index row = 0; row < particles.size(); ++row) {
    const std::size_t p = z(row);
    const bool sound = particles.x[p].allFinite() && particles.v[p].allFinite() && particles.stress[p].allFinite();
    if (sound && particles.F[p].determinant() > 0)
      continue;
    RemovedParticles<D> gone = mark_deleted(bodies, materials, particles, row);
    gone.failed = gone.mass, gone.failed_count = 1;
    removed.add(gone);
  }
  drop_lost(bodies, materials, particles);
  sort_by_cell(particles.cell, particles.id, bodies, mesh.n_cells(), order);
}

namespace {

/// Finds the particles that are not deep inside their cells.
template <int D>
void test_all(const Mesh<D>& mesh, const Locator<D>& locator, const Particles<D>& particles, CellOrder& order)
{
  order.begin_test();
  parallel_for_uneven(static_cast<Index>(order.keys()), [&](Index k) {
    const auto key = static_cast<std::size_t>(k);
    for_each_run(order.rows(key), particles.cell, [&](Index c, std::span<const Index> run) {
      const auto probe = locator.probe(mesh, c);
      for_each_pack(run, [&](const ParticlePack& pack) { add_leaving<D>(probe, pack, pack.load(particles.x), key, order); });
    });
  });
}

}  // namespace

template <int D>
bool relocate(const Mesh<D>& mesh, const Locator<D>& locator, const Exits& exits, std::vector<Body>& bodies,
              std::vector<Material>& materials, Particles<D>& particles, CellOrder& order, StepSums<D>& sums, ParticleErrors& errors)
{
  const bool unsorted = order.row.size() != particles.id.size();
  std::atomic<bool> moved = unsorted, outside = false;
  // Whether a particle is not in its cell; takes the new cell over where there is one.
  const auto find = [&](std::size_t p) {
    if (!particles.x[p].allFinite()) {
      errors.report(particles.id[p], Trouble::not_finite);
      return false;
    }
    const Index cell = locator(mesh, particles.x[p], particles.cell[p]).value_or(none);
    if (cell == particles.cell[p])
      return false;
    if (cell == none) {
      outside = true;
    } else {
      particles.cell[p] = cell;
      moved = true;
    }
    return true;
  };
  if (unsorted) {
    parallel_for(particles.size(), [&](Index p) { find(z(p)); });
  } else {
    if (!order.is_tested)
      test_all(mesh, locator, particles, order);
    parallel_for(static_cast<Index>(order.keys()), [&](Index k) {
      const std::span<Index> leaving = order.leaving_of(z(k));
      const auto left = std::remove_if(leaving.begin(), leaving.end(), [&](Index position) { return !find(z(order.row[z(position)])); });
      order.n_leaving[z(k)] = static_cast<Index>(left - leaving.begin());
    });
  }

  bool rows_changed = false;
  if (outside) {  // rare
    bool deleted = false;
    for (Index row = 0; row < particles.size(); ++row) {
      const std::size_t p = z(row);
      if (!particles.x[p].allFinite() || locator(mesh, particles.x[p], particles.cell[p]))
        continue;
      if (const auto back = set_back(mesh, locator, exits, particles.x[p])) {
        particles.x.set(p, back->x);
        particles.cell[p] = back->cell;
        sums.removed.add({.held_count = 1});
        sums.largest_set_back = std::max(sums.largest_set_back, back->distance);
        moved = true;
      } else if (exits.policy == OnExit::remove) {
        sums.removed.add(mark_deleted(bodies, materials, particles, row));
        deleted = true;
      } else {
        errors.report(particles.id[p], Trouble::lost);
      }
    }
    if (deleted)
      drop_lost(bodies, materials, particles);
    rows_changed = deleted;
    moved = moved || deleted;
  }

  if (unsorted || rows_changed)
    sort_by_cell(particles.cell, particles.id, bodies, mesh.n_cells(), order);
  else if (moved)
    sort_again(particles.cell, particles.id, order);
  order.is_tested = false;
  return rows_changed;
}

template <int D>
bool sort_by_cell(const std::vector<Body>& bodies, std::vector<Material>& materials, Particles<D>& particles, CellOrder& order)
{
  if (!std::exchange(order.is_new, false) || disorder(order) <= most_disorder)
    return false;
  static thread_local std::vector<std::byte> spare;
  static thread_local std::vector<Index> within;
  particles.for_each_column([&](std::string_view, std::string_view, auto& column) { permute(column, order.row, spare); });
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    within.resize(z(bodies[b].size()));
    for (Index i = 0; i < bodies[b].size(); ++i)
      within[z(i)] = order.row[z(bodies[b].begin + i)] - bodies[b].begin;
    materials[b].history.permute(within);
  }
  std::iota(order.row.begin(), order.row.end(), 0);
  return true;
}

template RemovedParticles<2> content_of<2>(const Vec<2>&, const Vec<2>&, Real, Real) noexcept;
template std::optional<SetBack<2>> set_back<2>(const Mesh<2>&, const Locator<2>&, const Exits&, const Vec<2>&) noexcept;
template RemovedParticles<2> content_of<2>(const std::vector<Body>&, const std::vector<Material>&, const Particles<2>&, Index);
template RemovedParticles<3> content_of<3>(const Vec<3>&, const Vec<3>&, Real, Real) noexcept;
template std::optional<SetBack<3>> set_back<3>(const Mesh<3>&, const Locator<3>&, const Exits&, const Vec<3>&) noexcept;
template RemovedParticles<3> content_of<3>(const std::vector<Body>&, const std::vector<Material>&, const Particles<3>&, Index);
template bool relocate<2>(const Mesh<2>&, const Locator<2>&, const Exits&, std::vector<Body>&, std::vector<Material>&, Particles<2>&,
                          CellOrder&, StepSums<2>&, ParticleErrors&);
template bool relocate<3>(const Mesh<3>&, const Locator<3>&, const Exits&, std::vector<Body>&, std::vector<Material>&, Particles<3>&,
                          CellOrder&, StepSums<3>&, ParticleErrors&);
template void drop_lost<2>(std::vector<Body>&, std::vector<Material>&, Particles<2>&);
template void drop_lost<3>(std::vector<Body>&, std::vector<Material>&, Particles<3>&);
template bool sort_by_cell<2>(const std::vector<Body>&, std::vector<Material>&, Particles<2>&, CellOrder&);
template bool sort_by_cell<3>(const std::vector<Body>&, std::vector<Material>&, Particles<3>&, CellOrder&);
template void remove_failed<2>(const Mesh<2>&, std::vector<Body>&, std::vector<Material>&, Particles<2>&, CellOrder&,
                               ExactSums<RemovedParticles<2>>&);
template void remove_failed<3>(const Mesh<3>&, std::vector<Body>&, std::vector<Material>&, Particles<3>&, CellOrder&,
                               ExactSums<RemovedParticles<3>>&);

}  // namespace talus
