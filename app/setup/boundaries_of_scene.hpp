#pragma once
// The block `boundaries` of a scene -> boundary conditions.
#include "app/setup/checks/cell_occupancy.hpp"
#include "app/setup/checks/scene_error_collector.hpp"
#include "app/setup/setup.hpp"

namespace talus {

/// Adds the conditions of the stage with that name.  For the `first` stage notes and warnings go to `setup`.  Every rank has to call.
template <int D>
void add_boundaries(const Scene& scene, const Mesh<D>& mesh, const CellOccupancy<D>& has_particles, Communicator& ranks,
                    const std::string& stage, bool first, SceneErrorCollector& errors, Setup<D>& setup, BoundaryConditions<D>& all);

}  // namespace talus
