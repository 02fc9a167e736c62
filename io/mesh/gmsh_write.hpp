#pragma once
// Writes the mesh that was used as .msh 4.1, so that gmsh, ParaView and later runs can open it.
#include <cstdint>
#include <filesystem>

#include "mesh/mesh.hpp"

namespace talus {

enum class MshKind : std::uint8_t { ascii, binary };

/// Nodes and cells in the order of the mesh (tag = number + 1), every named set as a physical group; a node set whose name a facet
/// or cell set has, too, is not told apart from it.  Numbers in text are exact.  Throws EnvironmentError.
template <int D>
void write_msh(const std::filesystem::path& file, const Mesh<D>& mesh, MshKind kind = MshKind::binary);

extern template void write_msh<2>(const std::filesystem::path&, const Mesh<2>&, MshKind);
extern template void write_msh<3>(const std::filesystem::path&, const Mesh<3>&, MshKind);

}  // namespace talus
