#pragma once
// The background mesh: immutable, of simplices only, with its adjacency and the named groups of gmsh.
#include <array>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "core/types.hpp"
#include "mesh/geometry/map_frame.hpp"

namespace talus {

/// A facet (edge in 2-D, triangle in 3-D) of a cell: the one opposite local node `local` of `cell`.
struct Facet {
  Index cell;
  Index local;
  friend bool operator==(const Facet&, const Facet&) = default;
};

/// A node of a cut and its twin, which lies at the same place and belongs to the cells on the other side.
template <int D>
struct NodePair {
  Index first, second;
  Index cut;     ///< number of the cut
  Vec<D> area;   ///< of the facets of the cut, shared evenly among their nodes; from the first side to the second [m^(D-1)]
  Real measure;  ///< the same without direction [m^(D-1)]
};

/// Groups of facets inside a mesh whose nodes are doubled, so that each side has its own.  Nodes at the border of a cut inside the mesh, its
/// tips, stay single.
template <int D>
struct MeshCuts {
  std::vector<NodePair<D>> pairs;  ///< ascending in the first node
  std::vector<Facet> facets;       ///< ascending; each facet twice, as one of both cells
  std::vector<Index> tips;         ///< ascending
};

/// What is wrong with one of the cuts that are asked for.
class CutError : public std::invalid_argument {
 public:
  CutError(std::size_t number, const std::string& what) : std::invalid_argument(what), cut(number) {}
  std::size_t cut;  ///< number of the cut
};

/// Mesh data from a reader or generator: numbers in any order, groups by name.
template <int D>
struct MeshData {
  std::vector<Vec<D>> nodes;                                            ///< coordinates [m]
  std::vector<std::array<Index, D + 1>> cells;                          ///< node numbers; Mesh corrects the orientation
  std::map<std::string, std::vector<Index>> node_sets;                  ///< points and curves (3-D): node numbers
  std::map<std::string, std::vector<std::array<Index, D>>> facet_sets;  ///< boundary or interior facets, by their nodes
  std::map<std::string, std::vector<Index>> cell_sets;                  ///< cell numbers
  std::optional<MapFrame> map = {};                                     ///< set for a mesh made from terrain
  std::vector<std::string> notes = {};                                  ///< corrections made during generation, to be printed as warnings
};

/// An immutable simplex mesh.  Cells are renumbered along a space-filling curve and nodes by first use, so that neighbouring numbers are
/// neighbours in space.  Degenerate or invalid data throw std::invalid_argument with cell or node and position.  Nodes of no cell are
/// dropped, also from the sets that name them.  Messages use the numbers of the data.
template <int D>
class Mesh {
 public:
  using Cell = std::array<Index, D + 1>;

  explicit Mesh(MeshData<D> data);
  /// A part of the mesh `whole`: some cells (ascending; may be empty) and their nodes, both in the order of the whole.  Sizes of nodes and
  /// the bounding box are those of the whole.  `neighbours`, `cells_of_node` and `ring_of_node` contain the cells of the part only.
  /// `boundary_facets` and `on_boundary` refer to the boundary of the whole, not to the cut.  Every named set exists, with its members in
  /// the part; an interior facet is listed with a cell of the part.
  Mesh(const Mesh& whole, std::span<const Index> cells);
  /// The mesh `uncut` with nodes doubled along facet groups inside it, whose names are `cuts`.  Stars and rings of nodes end at a cut;
  /// neighbours of cells are as before.  The first side of a piece of a cut is that from which its area vector points to +x, +y or +z, by
  /// the largest component; of a closed piece it is the inside.  Throws CutError for groups that are no cut.
  Mesh(Mesh uncut, std::span<const std::string> cuts);

  Index n_nodes() const noexcept { return static_cast<Index>(nodes_.size()); }
  Index n_cells() const noexcept { return static_cast<Index>(cells_.size()); }
  std::span<const Vec<D>> nodes() const noexcept { return nodes_; }
  std::span<const Cell> cells() const noexcept { return cells_; }
  /// Coordinates [m] of the corners of cell c, positively oriented (see simplex.hpp).
  std::array<Vec<D>, D + 1> corners(Index c) const noexcept;
  const Vec<D>& node(Index n) const noexcept { return nodes_[static_cast<std::size_t>(n)]; }
  const Cell& cell(Index c) const noexcept { return cells_[static_cast<std::size_t>(c)]; }

  Real volume(Index c) const noexcept { return volume_[static_cast<std::size_t>(c)]; }        ///< area in 2-D [m^D]
  Real altitude(Index c) const noexcept { return altitude_[static_cast<std::size_t>(c)]; }    ///< smallest altitude [m]
  std::span<const Real> altitudes() const noexcept { return altitude_; }                      ///< smallest altitude of each cell [m]
  Real node_size(Index n) const noexcept { return node_size_[static_cast<std::size_t>(n)]; }  ///< h_n, mean length of the edges at n [m]
  Real largest_edge() const noexcept { return largest_edge_; }                                ///< longest edge of all cells [m]
  const Vec<D>& low() const noexcept { return low_; }                                         ///< corners of the bounding box [m]
  const Vec<D>& high() const noexcept { return high_; }
  /// The position of the mesh on a map, if it was made from terrain.
  const std::optional<MapFrame>& map() const noexcept { return map_; }
  /// Descriptions of corrections made during generation.
  const std::vector<std::string>& notes() const noexcept { return notes_; }

  /// The cell across the facet opposite each local node, or `none` on the boundary and where a larger mesh was cut.
  const std::array<Index, D + 1>& neighbours(Index c) const noexcept { return neighbours_[static_cast<std::size_t>(c)]; }
  const Csr& cells_of_node() const noexcept { return cells_of_node_; }  ///< ascending
  /// False for nodes on the cut out of a larger mesh, which lack some of their cells.
  bool is_whole(Index n) const noexcept { return cut_.empty() || cut_[static_cast<std::size_t>(n)] == 0; }
  /// Nodes that share a cell with each node, including itself, ascending.
  const Csr& ring_of_node() const noexcept { return ring_of_node_; }
  std::span<const Facet> boundary_facets() const noexcept { return boundary_facets_; }
  const MeshCuts<D>& cuts() const noexcept { return cuts_; }
  Facet back(Facet f) const noexcept;  ///< the same facet inside the mesh, seen from its other cell
  /// With facets of cuts from both sides: each is followed by the same facet of its other cell.
  std::vector<Facet> both_sides_of_cuts(std::span<const Facet> facets) const;
  bool on_boundary(Facet f) const noexcept;  ///< false where a larger mesh was cut
  bool on_boundary(Index n) const noexcept { return on_boundary_[static_cast<std::size_t>(n)] != 0; }

  std::array<Index, D> nodes_of(Facet f) const noexcept;  ///< in the order that turns the normal outwards of f.cell
  Vec<D> area_vector(Facet f) const noexcept;             ///< outward normal of f.cell times length or area [m^(D-1)]

  /// Barycentric coordinates of x in cell c (sum to one; all >= 0 inside).
  std::array<Real, D + 1> barycentric(Index c, const Vec<D>& x) const noexcept;
  /// Gradients [1/m] of the D+1 barycentric coordinates of cell c.
  const std::array<Vec<D>, D + 1>& gradients(Index c) const noexcept { return gradients_[static_cast<std::size_t>(c)]; }

  /// The nodes of a named group of any dimension (nodes of its facets or cells), ascending; nothing if there is no such group.
  std::optional<std::vector<Index>> node_set(std::string_view name) const;
  /// The facets of a group, each once: boundary facets first, then interior ones, as facets of the lower numbered cell.
  std::optional<std::vector<Facet>> facet_set(std::string_view name) const;
  std::optional<std::vector<Index>> cell_set(std::string_view name) const;  ///< ascending
  std::vector<std::string> node_set_names() const;                          ///< all names that node_set() knows, sorted
  std::vector<std::string> facet_set_names() const;
  std::vector<std::string> cell_set_names() const;

 private:
  std::vector<Index> take_cells(const MeshData<D>& data, std::span<const Index> old_cells);
  void find_boundary();
  void measure();
  void take_sets(const MeshData<D>& data, std::span<const Index> new_cell, std::span<const Index> new_node);
  void take_sets(const Mesh& whole, std::span<const Index> new_cell, std::span<const Index> new_node);
  void take_cuts(const Mesh& whole, std::span<const Index> new_cell, std::span<const Index> new_node);

  std::vector<Vec<D>> nodes_;
  std::vector<Cell> cells_;
  std::vector<Real> volume_, altitude_, node_size_;
  std::vector<std::array<Vec<D>, D + 1>> gradients_;
  std::vector<std::array<Index, D + 1>> neighbours_;
  Csr cells_of_node_, ring_of_node_;
  std::vector<std::uint8_t> cut_;  ///< part of a mesh: whether a node lies on the cut
  std::vector<Facet> boundary_facets_;
  std::vector<std::uint8_t> on_boundary_;
  MeshCuts<D> cuts_;
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
