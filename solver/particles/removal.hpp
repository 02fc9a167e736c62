#pragma once
// Particles that leave the mesh or are removed.
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

/// Drops the particles whose cell is `none`.
template <int D>
void drop_lost(std::vector<Body>& bodies, std::vector<Material>& materials, Particles<D>& particles);

/// A position on the inside of a wall.
template <int D>
struct SetBack {
  Vec<D> x;
  Index cell;
  Real distance;  ///< from where the particle was [m]
};
/// Where a particle outside the mesh is set back to; nothing unless it is near a closed facet: weights of moving least squares do not vanish
/// beside a wall, so round-off of a cell's size may carry a particle across.
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
