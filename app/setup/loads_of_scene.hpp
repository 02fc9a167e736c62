#pragma once
// The block `loads` of a scene -> loads.
#include "app/setup/checks/cell_occupancy.hpp"
#include "app/setup/checks/scene_error_collector.hpp"
#include "app/setup/setup.hpp"

namespace talus {

/// `has_particles`: of all bodies, those as well that appear later; `at_start`: of the others.  Every rank has to ask.
template <int D>
void add_loads(const Scene& scene, const Mesh<D>& mesh, const CellOccupancy<D>& has_particles, const CellOccupancy<D>& at_start,
               Communicator& ranks, SceneErrorCollector& errors, Setup<D>& setup);

}  // namespace talus
