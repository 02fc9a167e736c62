#pragma once
// How many cells a mesh may have, asked before they are made.
#include <string>

#include "io/scene/scene.hpp"

namespace talus {

/// Meshes with more cells than this are taken for a slip of the pen: 10^8 tetrahedra need about 100 GB.
inline constexpr Real most_cells = 1e8;

/// Throws SceneErrors if so many cells, which `key` asks for, are more than that or than the memory there is holds.
template <int D>
void check_cells(Real cells, const std::string& key, const MeshSpec& spec);

extern template void check_cells<2>(Real, const std::string&, const MeshSpec&);
extern template void check_cells<3>(Real, const std::string&, const MeshSpec&);

}  // namespace talus
