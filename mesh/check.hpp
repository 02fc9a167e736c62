#pragma once
// Checks of mesh data before anything is built from them; messages name numbers and positions.
#include <span>
#include <string>
#include <string_view>

#include "mesh/mesh.hpp"

namespace talus {

/// A cell whose volume is less than this times (longest edge)^D is flat: its barycentric coordinates would be round-off.  The limit also
/// keeps every altitude above the tolerance of point location (1e-10 of the longest edge).
inline constexpr Real flat_cell = 1e-10;

/// A position as text, such as "(1.5, 0, 2)".
template <int D>
std::string place(const Vec<D>& x);

/// Numbers as text, such as "3, 8 and 9".
std::string and_list(std::span<const Index> numbers);

/// Throws std::invalid_argument for the first error in nodes or cells: no cells, coordinates that are not finite, node numbers out of
/// range, repeated nodes, cells without volume.
template <int D>
void check_nodes_and_cells(const MeshData<D>& data);

/// Throws unless 0 <= number < count, for example: `facet set "wall" refers to node 9, but nodes go from 0 to 7`.
void check_number(Index number, std::size_t count, std::string_view kind, std::string_view group, std::string_view what);

/// Renumbered cells and nodes, with their numbers in the original data, which messages use.
template <int D>
struct Renumbered {
  std::span<const std::array<Index, D + 1>> cells;
  std::span<const Vec<D>> nodes;
  std::span<const Index> cell_number, node_number;
};
/// Throws for a facet that belongs to three cells, with a message of its own if two of them are the same cell.
template <int D>
[[noreturn]] void refuse_crowded_facet(const Renumbered<D>& mesh, const std::array<Facet, 3>& claims);
/// Throws if a cell and its neighbour lie on the same side of their common facet, or have the same nodes.
template <int D>
void check_overlap(const Renumbered<D>& mesh, std::span<const std::array<Index, D + 1>> neighbours);

}  // namespace talus
