#pragma once
// Bodies of a scene -> particles.
#include "app/setup/initial.hpp"
#include "mesh/mesh.hpp"
#include "solver/stages.hpp"

namespace talus {

/// What the bodies of a scene become.
template <int D>
struct Seeds {
  Particles<D> particles;  ///< those of this rank
  Index n_particles = 0;   ///< of all ranks
  std::vector<Body> bodies;
  std::vector<Material> materials;
  std::optional<OriginSummary> origin;
  Real lag = 0;                 ///< by how much the velocities of another run are behind its time, Clock::lag [s]
  Real largest_before = 0;      ///< largest term of the energy of that run [J]
  bool water_flows_on = false;  ///< with the pressures that it had there
  EmptyCellStress<D> empty_cells;
};

/// Cells [begin, end) that this rank fills: an even share of the blocks along the curve.
template <int D>
IndexRange cells_to_fill(const Mesh<D>& mesh, const Communicator& ranks);

/// Each cell of a body holds particles at symmetric points of equal weight; a shape keeps those whose centre it contains.
/// Other bodies take the particles of another run, in the order of their ids there, and what they remember.
/// Complains about unknown groups, numbers of particles that no point set has, formulas and bodies without particles, particles outside the
/// mesh, laws that cannot go on from what there is; warns of cells that two bodies share and of stress that changes.
///
/// Every rank has to ask, with the same scene and mesh: each gets the particles in its cells_to_fill(), with the ids that they would have if one
/// rank filled all, and complains and warns in the same words.
template <int D>
Seeds<D> seed(const Scene& scene, const Mesh<D>& mesh, Communicator& ranks, SceneErrorCollector& errors,
              std::vector<std::string>& warnings);

}  // namespace talus
