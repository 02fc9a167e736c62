#include "solver/particles/removal.hpp"

#include <algorithm>
#include <cmath>

namespace talus {

namespace {

/// A particle set back onto a wall is placed this share of the cell's smallest altitude inside.
constexpr Real inset = 1e-6;

std::size_t z(Index i) { return static_cast<std::size_t>(i); }

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

template <int D>
void remove_failed(const Mesh<D>& mesh, std::vector<Body>& bodies, std::vector<Material>& materials, Particles<D>& particles,
                   CellOrder& order, ExactSums<RemovedParticles<D>>& removed)
{
  for (Index row = 0; row < particles.size(); ++row) {
    const std::size_t p = z(row);
    const bool sound = particles.x[p].allFinite() && particles.v[p].allFinite() && particles.stress[p].allFinite();
    if (sound && particles.F[p].determinant() > 0)
      continue;
    particles.cell[p] = none;
    RemovedParticles<D> gone = content_of(bodies, materials, particles, row);
    gone.failed = gone.mass, gone.failed_count = 1;
    removed.add(gone);
  }
  drop_lost(bodies, materials, particles);
  sort_by_cell(particles.cell, particles.id, bodies, mesh.n_cells(), order);
}

template RemovedParticles<2> content_of<2>(const Vec<2>&, const Vec<2>&, Real, Real) noexcept;
template std::optional<SetBack<2>> set_back<2>(const Mesh<2>&, const Locator<2>&, const Exits&, const Vec<2>&) noexcept;
template RemovedParticles<2> content_of<2>(const std::vector<Body>&, const std::vector<Material>&, const Particles<2>&, Index);
template RemovedParticles<3> content_of<3>(const Vec<3>&, const Vec<3>&, Real, Real) noexcept;
template std::optional<SetBack<3>> set_back<3>(const Mesh<3>&, const Locator<3>&, const Exits&, const Vec<3>&) noexcept;
template RemovedParticles<3> content_of<3>(const std::vector<Body>&, const std::vector<Material>&, const Particles<3>&, Index);
template void drop_lost<2>(std::vector<Body>&, std::vector<Material>&, Particles<2>&);
template void drop_lost<3>(std::vector<Body>&, std::vector<Material>&, Particles<3>&);
template void remove_failed<2>(const Mesh<2>&, std::vector<Body>&, std::vector<Material>&, Particles<2>&, CellOrder&,
                               ExactSums<RemovedParticles<2>>&);
template void remove_failed<3>(const Mesh<3>&, std::vector<Body>&, std::vector<Material>&, Particles<3>&, CellOrder&,
                               ExactSums<RemovedParticles<3>>&);

}  // namespace talus
