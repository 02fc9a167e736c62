#pragma once
// Cells that are too coarse for a softening length or for the correlation length of a random field.
#include <string>
#include <vector>

#include "core/parallel/communicator.hpp"
#include "core/particles.hpp"
#include "io/scene/scene.hpp"
#include "materials/interface/material.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// By the edges of cells in the mean over the particles of each body, a warning
/// - for a softening length with fewer than six cells over a shear band,
/// - for a random field so uneven within a cell that its mean there is more than a twentieth above the geometric mean.
/// Every rank has to ask.
template <int D>
void warn_of_coarse_cells(const Scene& scene, const Mesh<D>& mesh, const Particles<D>& particles, const std::vector<Body>& bodies,
                          const std::vector<Material>& materials, Communicator& ranks, std::vector<std::string>& warnings);

}  // namespace talus
