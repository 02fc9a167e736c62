#pragma once
// The background mesh: simplices only, immutable, with the adjacency the method needs and the named groups of gmsh.
#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/types.hpp"
#include "mesh/geometry/map_frame.hpp"

namespace talus {

/// A facet (edge in 2-D, triangle in 3-D), seen from a cell: opposite local node `local` of `cell`.
struct Facet {
  Index cell;
  Index local;
  friend bool operator==(const Facet&, const Facet&) = default;
};

/// What a reader or generator hands over: numbers in any order, groups by name.
template <int D>
struct MeshData {
  std::vector<Vec<D>> nodes;                                            ///< coordinates [m]
  std::vector<std::array<Index, D + 1>> cells;                          ///< node numbers; orientation is put right by Mesh
  std::map<std::string, std::vector<Index>> node_sets;                  ///< points and curves (3-D): node numbers
  std::map<std::string, std::vector<std::array<Index, D>>> facet_sets;  ///< boundary or interior facets by their nodes
  std::map<std::string, std::vector<Index>> cell_sets;                  ///< cell numbers
  std::optional<MapFrame> map = {};                                     ///< of a mesh that was made of terrain
  std::vector<std::string> notes = {};                                  ///< what was mended while it was made: warnings of whoever uses it
};

/// Immutable simplex mesh.  Cells are renumbered along a space-filling curve and nodes by first use, so that neighbours in
/// number are neighbours in space.  Degenerate or broken data throw std::invalid_argument saying which cell or node, where.
///
/// Nodes that no cell uses are dropped, also from the sets that name them.  Messages use the numbers of the data.
template <int D>
class Mesh {
 public:
  using Cell = std::array<Index, D + 1>;

  explicit Mesh(MeshData<D> data);
  /// Some cells of `whole` (ascending; may be none) and the nodes they use, both in the order of the whole.  What was measured there is
  /// taken over, so that a node at the rim knows its size, and the box is that of the whole.  `neighbours`, `cells_of_node` and
  /// `ring_of_node` know the cells held.  Where the mesh was cut is no boundary: `boundary_facets` and `on_boundary` are those of the
  /// whole.  Every named set is there, if only with the members held; a facet inside is seen from a cell that is held.
  Mesh(const Mesh& whole, std::span<const Index> cells);

  Index n_nodes() const noexcept { return static_cast<Index>(nodes_.size()); }
  Index n_cells() const noexcept { return static_cast<Index>(cells_.size()); }
  std::span<const Vec<D>> nodes() const noexcept { return nodes_; }
  std::span<const Cell> cells() const noexcept { return cells_; }
  /// Coordinates [m] of the corners of cell c, positively oriented (see simplex.hpp).
  std::array<Vec<D>, D + 1> corners(Index c) const noexcept;
  const Vec<D>& node(Index n) const noexcept { return nodes_[static_cast<std::size_t>(n)]; }
  const Cell& cell(Index c) const noexcept { return cells_[static_cast<std::size_t>(c)]; }

  Real volume(Index c) const noexcept { return volume_[static_cast<std::size_t>(c)]; }        ///< area in 2-D [m^D]
  Real altitude(Index c) const noexcept { return altitude_[static_cast<std::size_t>(c)]; }    ///< the smallest one [m]
  std::span<const Real> altitudes() const noexcept { return altitude_; }                      ///< of all cells
  Real node_size(Index n) const noexcept { return node_size_[static_cast<std::size_t>(n)]; }  ///< h_n, mean length of the edges at n [m]
  Real largest_edge() const noexcept { return largest_edge_; }                                ///< of all cells [m]
  const Vec<D>& low() const noexcept { return low_; }                                         ///< corners of the bounding box [m]
  const Vec<D>& high() const noexcept { return high_; }
  /// Where the mesh lies on a map, if it was made of terrain.
  const std::optional<MapFrame>& map() const noexcept { return map_; }
  /// What was mended while it was made, in words.
  const std::vector<std::string>& notes() const noexcept { return notes_; }

  /// Cell across the facet opposite each local node, or `none` on the boundary and where a larger mesh was cut.
  const std::array<Index, D + 1>& neighbours(Index c) const noexcept { return neighbours_[static_cast<std::size_t>(c)]; }
  const Csr& cells_of_node() const noexcept { return cells_of_node_; }  ///< ascending
  /// False for nodes where the mesh was cut out of a larger one: cells around them are missing.
  bool is_whole(Index n) const noexcept { return cut_.empty() || cut_[static_cast<std::size_t>(n)] == 0; }
  const Csr& ring_of_node() const noexcept { return ring_of_node_; }  ///< nodes that share a cell with it, itself included, ascending
  std::span<const Facet> boundary_facets() const noexcept { return boundary_facets_; }
  bool on_boundary(Facet f) const noexcept;  ///< false where a larger mesh was cut
  bool on_boundary(Index n) const noexcept { return on_boundary_[static_cast<std::size_t>(n)] != 0; }

  std::array<Index, D> nodes_of(Facet f) const noexcept;  ///< in the order that turns the normal outwards of f.cell
  Vec<D> area_vector(Facet f) const noexcept;             ///< outward normal of f.cell times length or area [m^(D-1)]

  /// Barycentric coordinates of x in cell c (sum to one; all >= 0 inside).
  std::array<Real, D + 1> barycentric(Index c, const Vec<D>& x) const noexcept;
  /// Gradients [1/m] of the D+1 barycentric coordinates of cell c.
  const std::array<Vec<D>, D + 1>& gradients(Index c) const noexcept { return gradients_[static_cast<std::size_t>(c)]; }

  /// Nodes of a named group of any dimension (nodes of its facets or cells), ascending; nothing if there is no such group.
  std::optional<std::vector<Index>> node_set(std::string_view name) const;
  /// Each facet once: those on the boundary first, then interior ones, seen from the lower numbered of their two cells.
  std::optional<std::vector<Facet>> facet_set(std::string_view name) const;
  std::optional<std::vector<Index>> cell_set(std::string_view name) const;  ///< ascending
  std::vector<std::string> node_set_names() const;                          ///< every name node_set() knows, sorted
  std::vector<std::string> facet_set_names() const;
  std::vector<std::string> cell_set_names() const;

 private:
  std::vector<Index> take_cells(const MeshData<D>& data, std::span<const Index> old_cells);
  void find_boundary();
  void measure();
  void take_sets(const MeshData<D>& data, std::span<const Index> new_cell, std::span<const Index> new_node);
  void take_sets(const Mesh& whole, std::span<const Index> new_cell, std::span<const Index> new_node);

  std::vector<Vec<D>> nodes_;
  std::vector<Cell> cells_;
  std::vector<Real> volume_, altitude_, node_size_;
  std::vector<std::array<Vec<D>, D + 1>> gradients_;
  std::vector<std::array<Index, D + 1>> neighbours_;
  Csr cells_of_node_, ring_of_node_;
  std::vector<std::uint8_t> cut_;  ///< of a mesh of some cells of another: by node
  std::vector<Facet> boundary_facets_;
  std::vector<std::uint8_t> on_boundary_;
  Real largest_edge_;
  Vec<D> low_, high_;
  std::optional<MapFrame> map_;
  std::vector<std::string> notes_;
  std::map<std::string, std::vector<Index>, std::less<>> node_sets_, cell_sets_;
  std::map<std::string, std::vector<Facet>, std::less<>> facet_sets_;
};

extern template class Mesh<2>;
extern template class Mesh<3>;

}  // namespace talus
