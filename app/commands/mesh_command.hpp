#pragma once
// Command talus mesh.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

struct MeshOptions {
  std::filesystem::path file;  ///< a scene, a .msh, or a geometry
  std::vector<std::string> set;
  std::optional<Real> size;      ///< edge length for a geometry [m]
  std::optional<int> dimension;  ///< dimension of a file; default: that of its largest cells
  std::optional<std::filesystem::path> out;
};
/// Prints statistics and groups of a mesh; optionally writes it.
void show_mesh(const MeshOptions& options);

}  // namespace talus
