#pragma once
// Cells that overlap, and unconnected nodes at the same position: errors of meshes that the facets do not show.
#include <cstdint>
#include <optional>
#include <vector>

#include "mesh/mesh.hpp"

namespace talus {

/// Cells that overlap although they share no facet.
struct OverlappingCells {
  Index first, second;  ///< the lowest numbered pair
  std::int64_t pairs;   ///< number of pairs with a cell at the boundary
};

/// Two cells overlap if they penetrate each other by more than this times the smallest altitude of the two; less is round-off of text
/// files.
inline constexpr Real least_penetration = 1e-3;

/// The overlapping cells, or nothing.  A region that is covered twice ends at a facet of the boundary, so only the cells at the boundary
/// are compared with others: n^((D-1)/D) of n cells, each with those around it.
template <int D>
std::optional<OverlappingCells> find_overlap(const Mesh<D>& mesh);

/// Groups of two or more nodes of the facet set "boundary" at the same position, within 1e-6 of the shortest edge there.  The cells at them
/// are not connected: the mesh has a crack.  In the order of their lowest node numbers.
template <int D>
std::vector<std::vector<Index>> unjoined_nodes(const MeshData<D>& data);

}  // namespace talus
