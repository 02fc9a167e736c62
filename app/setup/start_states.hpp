#pragma once
// Bodies that start with the stress and other values of a table of points.
#include "app/setup/checks/scene_error_collector.hpp"
#include "app/setup/setup.hpp"

namespace talus {

/// Gives particles of bodies with the key `initial` the state of their tables, each the value of the plane that fits the points around it
/// best (linear_fit.hpp).  Complains of tables that cannot be read, laws that cannot start from a stress or do not take that of a particle,
/// particles beyond the points, total stress where the pore pressure is not known; warns of stress beyond the yield surface, which the first
/// step returns to it, and of signs that are hardly meant.  Every rank has to ask, after the water table is known.
template <int D>
void set_start_states(const Scene& scene, const Mesh<D>& mesh, Communicator& ranks, SceneErrorCollector& errors, Setup<D>& setup);

}  // namespace talus
