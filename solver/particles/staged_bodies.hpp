#pragma once
// Bodies that come and go between two steps, as stages want it.
#include <span>
#include <string>
#include <vector>

#include "core/parallel/communicator.hpp"
#include "core/particles.hpp"
#include "materials/interface/material.hpp"
#include "mesh/mesh.hpp"
#include "solver/state/cell_order.hpp"

namespace talus {

/// Particles apart from those of a model, whose bodies they are, in the same order; of most bodies there are none.
template <int D>
struct ParticleSet {
  std::vector<Body> bodies;
  std::vector<Material> materials;
  Particles<D> particles;
};

/// Moves the particles of the bodies that `goes` names, by their numbers, out of those that are there.
template <int D>
ParticleSet<D> extract_bodies(std::span<const Index> goes, std::vector<Body>& bodies, std::vector<Material>& materials,
                              Particles<D>& particles);

/// The particles of the crowd stand behind those that their bodies have.  Columns must be the same, but where one side has no particles;
/// laws of bodies that come must be the same as well.
template <int D>
void insert_particles(ParticleSet<D> arriving, std::vector<Body>& bodies, std::vector<Material>& materials, Particles<D>& particles);

/// Volume of the particles in each cell [m^D], of those rows in `order` whose body is `chosen`.
template <int D, class Chosen>
std::vector<Real> volume_in_cells(const Mesh<D>& mesh, const Particles<D>& particles, const CellOrder& order, Chosen&& chosen)
{
  std::vector<Real> volume(static_cast<std::size_t>(mesh.n_cells()), 0);
  for (std::size_t key = 0; key < order.keys(); ++key)
    if (chosen(static_cast<Index>(key) / order.blocks))
      for (const Index row : order.rows(key))
        volume[static_cast<std::size_t>(particles.cell[static_cast<std::size_t>(row)])] += particles.volume[static_cast<std::size_t>(row)];
  return volume;
}

/// Where material comes to a place that other material has.
template <int D>
struct Overlap {
  Real volume{};         ///< that cells would hold beyond their own [m^D]
  Real coming{};         ///< volume that comes [m^D]
  std::int64_t cells{};  ///< with more than their own
  std::string place{};   ///< centre of the fullest of them
  /// Of what comes.
  Real share() const noexcept { return coming > 0 ? volume / coming : 0; }
};
/// Every rank has to ask; of each cell one rank knows the volumes.
template <int D>
Overlap<D> overlap(const Mesh<D>& mesh, std::span<const Real> there, std::span<const Real> coming, Communicator& ranks);

}  // namespace talus
