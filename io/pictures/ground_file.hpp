#pragma once
// Reads the ground from the mesh file of a results folder.
#include <filesystem>
#include <optional>

#include "mesh/rigid_ground.hpp"

namespace talus {

/// The ground in mesh.msh of the results of a run in this dimension.  Nothing if the file does not exist or its mesh was not made from
/// terrain, which is determined without reading all of it.  Throws EnvironmentError with the name of the file if it cannot be read.
std::optional<RigidGround> read_ground(const std::filesystem::path& folder, int dimension);

}  // namespace talus
