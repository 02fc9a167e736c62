#pragma once
// Cells that cover the same place, and nodes at the same place that are not joined: faults of meshes that facets do not show.
#include <cstdint>
#include <optional>
#include <vector>

#include "mesh/mesh.hpp"

namespace talus {

/// Cells that overlap although they share no facet.
struct OverlappingCells {
  Index first, second;  ///< the lowest numbered pair
  std::int64_t pairs;   ///< how many pairs a cell at the boundary is part of
};

/// Two cells overlap if they penetrate each other by more than this times the smallest altitude of the two: less is round-off of coordinates in
/// text files.
inline constexpr Real least_penetration = 1e-3;

/// Nothing if no place is covered twice.  A place that is covered twice ends at a facet of the boundary, so only the cells there are compared
/// with others: n^((D-1)/D) of n cells, each with those around it.
template <int D>
std::optional<OverlappingCells> find_overlap(const Mesh<D>& mesh);

/// Groups of two nodes or more of the facet set "boundary" at the same place, up to 1e-6 of the shortest edge there.  The cells at them are
/// not joined: the mesh has a crack.  In the order of their lowest node numbers.
template <int D>
std::vector<std::vector<Index>> unjoined_nodes(const MeshData<D>& data);

extern template std::optional<OverlappingCells> find_overlap<2>(const Mesh<2>&);
extern template std::optional<OverlappingCells> find_overlap<3>(const Mesh<3>&);
extern template std::vector<std::vector<Index>> unjoined_nodes<2>(const MeshData<2>&);
extern template std::vector<std::vector<Index>> unjoined_nodes<3>(const MeshData<3>&);

}  // namespace talus
