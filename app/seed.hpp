#pragma once
// Bodies of a scene -> particles.
#include "app/initial.hpp"
#include "mesh/mesh.hpp"
#include "solver/run.hpp"

namespace talus {

/// What the bodies of a scene become.
template <int D>
struct Seeds {
  Particles<D> particles;
  std::vector<Body> bodies;
  std::vector<AnyBatch> materials;
  std::optional<OriginSummary> origin;
};

/// Each cell of a body holds particles at symmetric points of equal weight; a shape keeps those whose centre it contains.
/// Other bodies take the particles of another run, in the order of their ids there, and what they remember.
/// Complains about unknown groups, numbers of particles that no point set has, formulas and bodies without particles, particles outside the
/// mesh, laws that cannot go on from what there is; warns of cells that two bodies share and of stress that changes.
template <int D>
Seeds<D> seed(const Scene& scene, const Mesh<D>& mesh, Complaints& complaints, std::vector<std::string>& warnings);

extern template Seeds<2> seed<2>(const Scene&, const Mesh<2>&, Complaints&, std::vector<std::string>&);
extern template Seeds<3> seed<3>(const Scene&, const Mesh<3>&, Complaints&, std::vector<std::string>&);

}  // namespace talus
