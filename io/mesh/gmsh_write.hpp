#pragma once
// Writes the mesh of a run as .msh 4.1, for gmsh, ParaView and later runs.
#include <cstdint>
#include <filesystem>

#include "mesh/mesh.hpp"

namespace talus {

enum class MshKind : std::uint8_t { ascii, binary };

/// Writes nodes and cells in the order of the mesh (tag = number + 1) and every named set as a physical group.  A node set with the name of
/// a facet or cell set is merged with it.  Numbers in text are exact.  Throws EnvironmentError.
template <int D>
void write_msh(const std::filesystem::path& file, const Mesh<D>& mesh, MshKind kind = MshKind::binary);

}  // namespace talus
