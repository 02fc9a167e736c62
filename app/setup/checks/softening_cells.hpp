#pragma once
// Cells that are too coarse for a softening length.
#include <string>
#include <vector>

#include "core/parallel/communicator.hpp"
#include "core/particles.hpp"
#include "io/scene/scene.hpp"
#include "materials/interface/material.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// A warning for each body with a softening length that has fewer than six cells over a shear band, by the edges of cells in the mean over its
/// particles.  Every rank has to ask.
template <int D>
void warn_of_coarse_cells(const Scene& scene, const Mesh<D>& mesh, const Particles<D>& particles, const std::vector<Body>& bodies,
                          const std::vector<Material>& materials, Communicator& ranks, std::vector<std::string>& warnings);

}  // namespace talus
