#pragma once
// The cell of every particle, the order by cell, and particles that are about to leave the mesh.
#include "core/particle_errors.hpp"
#include "materials/interface/material.hpp"
#include "mesh/locate.hpp"
#include "solver/options/limit_options.hpp"
#include "solver/state/cell_order.hpp"
#include "solver/state/step_sums.hpp"

namespace talus {

/// What happens at the boundary of the mesh.
struct Exits {
  OnExit policy = OnExit::stop;
  std::vector<std::uint8_t> closed;  ///< one bit per local facet of each cell: a wall that no particle passes
};

/// Finds each particle's cell.  A particle outside behind a closed facet is set back onto it: weights of moving least squares do
/// not vanish beside a wall, so round-off of a cell's size may carry a particle across.  Others are reported lost or deleted.
/// The mass, momentum and energy of deleted particles are added to `sums`.  Afterwards `order` is sorted.
/// True if rows changed place.
template <int D>
bool relocate(const Mesh<D>& mesh, const Locator<D>& locator, const Exits& exits, std::vector<Body>& bodies,
              std::vector<Material>& materials, Particles<D>& particles, CellOrder& order, StepSums<D>& sums, ParticleErrors& errors);

/// Adds the particles of a pack that are not well inside their cell to the list `leaving` of the order.
template <int D>
[[gnu::always_inline]] inline void add_leaving(const typename Locator<D>::Probe& probe, const ParticlePack& pack, const VecOf<D>& x,
                                               std::size_t key, CellOrder& order) noexcept
{
  if (const auto deep = probe.deep_each(x); !all_of(deep))
    for (int lane = 0; lane < pack.count; ++lane)
      if (!deep[lane])
        order.add_leaving(key, pack.listed + lane);
}

/// Drops the particles whose cell is `none`.
template <int D>
void drop_lost(std::vector<Body>& bodies, std::vector<Material>& materials, Particles<D>& particles);

/// Sorts the arrays by `order` where too many rows are out of place.  True if rows changed place.
template <int D>
bool sort_by_cell(const std::vector<Body>& bodies, std::vector<Material>& materials, Particles<D>& particles, CellOrder& order);

/// A position on the inside of a wall.
template <int D>
struct SetBack {
  Vec<D> x;
  Index cell;
  Real distance;  ///< from where the particle was [m]
};
/// Where a particle outside the mesh is set back to; nothing unless it is near a closed facet.
template <int D>
std::optional<SetBack<D>> set_back(const Mesh<D>& mesh, const Locator<D>& locator, const Exits& exits, const Vec<D>& x) noexcept;

/// Count, mass, momentum and energy of a particle that is removed or added.  `plastic_work` [J] is that of its law.
template <int D>
RemovedParticles<D> content_of(const Vec<D>& x, const Vec<D>& v, Real mass, Real plastic_work) noexcept;
template <int D>
RemovedParticles<D> content_of(const std::vector<Body>& bodies, const std::vector<Material>& materials, const Particles<D>& particles,
                               Index row);

/// Deletes the particles that no step can go on from: position, velocity, deformation or stress not finite, or turned inside out.
template <int D>
void remove_failed(const Mesh<D>& mesh, std::vector<Body>& bodies, std::vector<Material>& materials, Particles<D>& particles,
                   CellOrder& order, ExactSums<RemovedParticles<D>>& removed);

}  // namespace talus
