#pragma once
// Converts nodes, elements and group names of gmsh to MeshData, for readers of files and of gmsh itself.
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mesh/mesh.hpp"

namespace talus {

/// The dimension of a first-order simplex of gmsh: 0 for type 15 (point), 1, 2, 3 for types 1, 2, 4 (edge, triangle, tetrahedron).  Throws
/// std::invalid_argument with advice for every other type, and for simplices of more than `highest` dimensions.
int dimension_of_element(std::int64_t type, int highest);

/// Receives nodes, then elements, one by one.  Errors are std::invalid_argument without a position, which the caller knows.
template <int D>
class MshAssembler {
 public:
  void name_group(int dimension, std::int64_t tag, std::string name);
  void add_node(std::int64_t tag, const Vec3& x);
  /// Ends the nodes; elements that use them may follow.
  void close_nodes();
  /// Adds an element with the tags of its physical groups (may be empty) and dimension + 1 nodes.
  void add_element(std::int64_t tag, int dimension, std::span<const std::int64_t> groups, std::span<const std::int64_t> node_tags);
  /// Returns the mesh.  Nodes of no cell are dropped; groups without elements are left out; groups without a name are called
  /// physical_<dimension>_<tag>.  `repeats`: a cell in several groups was written several times (format 2.2), and becomes one.  A cell that
  /// was written several times in one group, or in none, is noted.
  MeshData<D> finish(bool repeats);

 private:
  using Cell = std::array<Index, D + 1>;
  using Key = std::pair<int, std::int64_t>;  ///< dimension and tag of a group
  Index node_of_tag(std::int64_t tag, std::int64_t element) const;
  void check_cell(std::int64_t tag, const Cell& cell) const;
  void check_element_tags();
  std::vector<Index> unite_repeated_cells();
  std::string name_of(const Key& group) const;

  std::map<Key, std::string> names_;
  std::vector<Vec3> nodes_;
  std::vector<std::int64_t> node_tags_;
  std::vector<std::pair<std::int64_t, Index>> by_tag_;  ///< sorted by tag; empty if the tags are consecutive
  Real extent_ = 0;                                     ///< longest side of the bounding box in x and y [m]
  std::vector<std::int64_t> element_tags_;
  std::vector<Cell> cells_;
  std::map<Key, std::vector<Index>> cells_of_;
  std::map<Key, std::vector<std::array<Index, D>>> facets_of_;
  std::map<Key, std::vector<Index>> nodes_of_;
};

extern template class MshAssembler<2>;
extern template class MshAssembler<3>;

}  // namespace talus
