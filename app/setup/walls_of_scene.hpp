#pragma once
// The block `boundaries` of a scene -> walls.
#include "app/setup/cell_occupancy.hpp"
#include "app/setup/checks/scene_error_collector.hpp"
#include "app/setup/setup.hpp"

namespace talus {

/// Adds the walls of a stage, called by its name.  Of the `first` stage it is told what is worth a word: notes and warnings of `setup`.  Every rank
/// has to ask.
template <int D>
void add_walls(const Scene& scene, const Mesh<D>& mesh, const CellOccupancy<D>& has_particles, Communicator& ranks,
               const std::string& stage, bool first, SceneErrorCollector& complaints, Setup<D>& setup, BoundaryConditions<D>& walls);

extern template void add_walls<2>(const Scene&, const Mesh<2>&, const CellOccupancy<2>&, Communicator&, const std::string&, bool,
                                  SceneErrorCollector&, Setup<2>&, BoundaryConditions<2>&);
extern template void add_walls<3>(const Scene&, const Mesh<3>&, const CellOccupancy<3>&, Communicator&, const std::string&, bool,
                                  SceneErrorCollector&, Setup<3>&, BoundaryConditions<3>&);

}  // namespace talus
