#pragma once
// The ground in the mesh file of a run's folder.
#include <filesystem>
#include <optional>

#include "mesh/rigid_ground.hpp"

namespace talus {

/// Of mesh.msh in the folder of a run of that dimension.  Nothing where there is no such file or its mesh is not one of terrain, which is seen
/// without reading all of it.  EnvironmentError naming the file if it cannot be read.
std::optional<RigidGround> read_ground(const std::filesystem::path& folder, int dimension);

}  // namespace talus
