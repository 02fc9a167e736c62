#pragma once
// Limits on the number of cells, checked before a mesh is made.
#include <string>

#include "io/scene/scene.hpp"

namespace talus {

/// Larger meshes are taken for a typing error: 10^8 tetrahedra need about 100 GB.
inline constexpr Real most_cells = 1e8;

/// Throws SceneErrors if the number of cells, which follows from `key`, exceeds this limit or the memory of the machine.
template <int D>
void check_cells(Real cells, const std::string& key, const MeshSpec& spec);

}  // namespace talus
