#pragma once
// The block `loads` of a scene -> loads.
#include "app/setup/cell_occupancy.hpp"
#include "app/setup/checks/scene_error_collector.hpp"
#include "app/setup/setup.hpp"

namespace talus {

/// `has_particles`: of all bodies, those as well that appear later; `at_start`: of the others.  Every rank has to ask.
template <int D>
void add_loads(const Scene& scene, const Mesh<D>& mesh, const CellOccupancy<D>& has_particles, const CellOccupancy<D>& at_start,
               Communicator& ranks, SceneErrorCollector& errors, Setup<D>& setup);

extern template void add_loads<2>(const Scene&, const Mesh<2>&, const CellOccupancy<2>&, const CellOccupancy<2>&, Communicator&,
                                  SceneErrorCollector&, Setup<2>&);
extern template void add_loads<3>(const Scene&, const Mesh<3>&, const CellOccupancy<3>&, const CellOccupancy<3>&, Communicator&,
                                  SceneErrorCollector&, Setup<3>&);

}  // namespace talus
