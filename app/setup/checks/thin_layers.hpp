#pragma once
// Layers of one material that are too thin for the cells between others.
#include <string>
#include <vector>

#include "core/parallel/communicator.hpp"
#include "io/scene/scene.hpp"
#include "solver/model/model.hpp"

namespace talus {

/// A warning for each material of which more than a third of the cells are *thin*: all vertices of the cell have a cell of another material
/// around them, so no node belongs to the layer alone and neighbours stiffen it.  A layer of one cell has thin cells only, one of two cells
/// a few at its ends.  Bodies that are there at the start are looked at, those of each velocity field by themselves.  Every rank has to ask.
template <int D>
void warn_of_thin_layers(const Scene& scene, const Mesh<D>& mesh, const Particles<D>& particles, const std::vector<Body>& bodies,
                         const std::vector<Material>& materials, const Contacts& contacts, Communicator& ranks,
                         std::vector<std::string>& warnings);

}  // namespace talus
