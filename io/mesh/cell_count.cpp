#include "io/mesh/cell_count.hpp"

#include <fmt/format.h>

#include "io/system/memory.hpp"

namespace talus {

namespace {

/// The memory of each cell in a Mesh and its MeshData [B]: its nodes three times, neighbours, volume, altitude, gradients.
template <int D>
constexpr Real bytes_of_cell = 4 * (D + 1) * sizeof(Index) + (2 + D * (D + 1)) * sizeof(Real);

}  // namespace

template <int D>
void check_cells(Real cells, const std::string& key, const MeshSpec& spec)
{
  if (!(cells <= most_cells))
    throw SceneErrors(spec.where, fmt::format("{} asks for {:.3g} cells, more than {:.3g}", key, cells, most_cells));
  if (const std::string why = too_many(cells, "cells", bytes_of_cell<D>); !why.empty())
    throw SceneErrors(spec.where, fmt::format("{} {}", key, why));
}

template void check_cells<2>(Real, const std::string&, const MeshSpec&);
template void check_cells<3>(Real, const std::string&, const MeshSpec&);

}  // namespace talus
