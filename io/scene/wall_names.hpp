#pragma once
// Names of boundary conditions in outputs and stages.
#include <string>
#include <vector>

#include "mesh/conditions/conditions.hpp"

namespace talus {

/// The names: that of the group of the condition; the second one on a group is `<group>_2`, and so on.
std::vector<std::string> wall_names(const std::vector<BoundaryOptions>& boundaries);

}  // namespace talus
