#pragma once
// The cell of every particle, the order by cell, and particles that are about to leave the mesh.
#include "core/particle_errors.hpp"
#include "materials/material.hpp"
#include "mesh/locate.hpp"
#include "solver/state/cell_order.hpp"
#include "solver/state/step_sums.hpp"

namespace talus {

enum class OnExitPolicy : std::uint8_t { stop, remove };

/// What happens at the boundary of the mesh.
struct Exits {
  OnExitPolicy policy = OnExitPolicy::stop;
  std::vector<std::uint8_t> closed;  ///< one bit per local facet of each cell: a wall that no particle passes
};

/// Finds each particle's cell.  A particle outside behind a closed facet is set back onto it: weights of moving least squares do
/// not vanish beside a wall, so round-off of a cell's size may carry a particle across.  Others are reported lost or deleted.
/// What deleted particles take along is added to the tally.  Afterwards `order` is sorted.
/// True if rows changed place.
template <int D>
bool relocate(const Mesh<D>& mesh, const Locator<D>& locator, const Exits& exits, std::vector<Body>& bodies,
              std::vector<Material>& materials, Particles<D>& particles, CellOrder& order, StepSums<D>& sums, ParticleErrors& health);

/// Drops the particles whose cell is `none`.
template <int D>
void drop_lost(std::vector<Body>& bodies, std::vector<Material>& materials, Particles<D>& particles);

/// Sorts the arrays by `order` where too many rows are out of place.  True if rows changed place.
template <int D>
bool sort_by_cell(const std::vector<Body>& bodies, std::vector<Material>& materials, Particles<D>& particles, CellOrder& order);

/// What a particle takes along that goes, or brings that comes, as far as it is a number.
template <int D>
RemovedParticles<D> content_of(const std::vector<Body>& bodies, const std::vector<Material>& materials, const Particles<D>& particles,
                               Index row);

/// Deletes the particles that no step can go on from: position, velocity, deformation or stress not finite, or turned inside out.
template <int D>
void remove_failed(const Mesh<D>& mesh, std::vector<Body>& bodies, std::vector<Material>& materials, Particles<D>& particles,
                   CellOrder& order, ExactSums<RemovedParticles<D>>& departed);

extern template RemovedParticles<2> content_of<2>(const std::vector<Body>&, const std::vector<Material>&, const Particles<2>&, Index);
extern template RemovedParticles<3> content_of<3>(const std::vector<Body>&, const std::vector<Material>&, const Particles<3>&, Index);
extern template bool relocate<2>(const Mesh<2>&, const Locator<2>&, const Exits&, std::vector<Body>&, std::vector<Material>&, Particles<2>&,
                                 CellOrder&, StepSums<2>&, ParticleErrors&);
extern template bool relocate<3>(const Mesh<3>&, const Locator<3>&, const Exits&, std::vector<Body>&, std::vector<Material>&, Particles<3>&,
                                 CellOrder&, StepSums<3>&, ParticleErrors&);
extern template void drop_lost<2>(std::vector<Body>&, std::vector<Material>&, Particles<2>&);
extern template void drop_lost<3>(std::vector<Body>&, std::vector<Material>&, Particles<3>&);
extern template bool sort_by_cell<2>(const std::vector<Body>&, std::vector<Material>&, Particles<2>&, CellOrder&);
extern template bool sort_by_cell<3>(const std::vector<Body>&, std::vector<Material>&, Particles<3>&, CellOrder&);
extern template void remove_failed<2>(const Mesh<2>&, std::vector<Body>&, std::vector<Material>&, Particles<2>&, CellOrder&,
                                      ExactSums<RemovedParticles<2>>&);
extern template void remove_failed<3>(const Mesh<3>&, std::vector<Body>&, std::vector<Material>&, Particles<3>&, CellOrder&,
                                      ExactSums<RemovedParticles<3>>&);

}  // namespace talus
