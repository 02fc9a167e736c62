#pragma once
// What the walls of a scene are called in outputs and stages.
#include <string>
#include <vector>

#include "mesh/conditions/conditions.hpp"

namespace talus {

/// Walls are called by the group that they are on; the second on a group is `<group>_2`, and so on.
std::vector<std::string> wall_names(const std::vector<BoundaryOptions>& boundaries);

}  // namespace talus
