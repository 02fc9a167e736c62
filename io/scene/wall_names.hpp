#pragma once
// What the walls of a scene are called in outputs and stages.
#include "io/scene/scene_loads.hpp"

namespace talus {

/// Walls are called by the group that they are on; the second on a group is `<group>_2`, and so on.
std::vector<std::string> wall_names(const std::vector<BoundarySpec>& boundaries);

}  // namespace talus
