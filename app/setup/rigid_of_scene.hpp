#pragma once
// The rigid bodies of a scene, and the walls that they touch.
#include <string>
#include <vector>

#include "app/setup/checks/scene_error_collector.hpp"
#include "app/setup/setup.hpp"

namespace talus {

/// Adds the rigid bodies and their states at the start, and the walls: the boundary facets of groups with conditions, as the first stage has
/// them.  Surfaces that are open or inside out, and bodies that begin inside material or inside each other, are errors.  Collective.
template <int D>
void add_rigid_bodies(const Scene& scene, const Mesh<D>& mesh, Communicator& ranks, SceneErrorCollector& errors, Setup<D>& setup);

}  // namespace talus
