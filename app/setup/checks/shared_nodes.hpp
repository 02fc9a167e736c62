#pragma once
// Cells that two bodies fill at once, and bodies that share nodes at the start: those that touch, and those that act upon each other across a
// gap because cells are coarse.
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "app/setup/checks/scene_error_collector.hpp"
#include "core/parallel/communicator.hpp"
#include "core/particles.hpp"
#include "io/scene/scene.hpp"
#include "mesh/mesh.hpp"
#include "solver/model/model.hpp"

namespace talus {

/// Two bodies with mass on the same nodes.
struct SharedNodes {
  Index first, second;  ///< bodies
  std::int64_t nodes;
  bool touch;  ///< no more than a particle's own spacing lies between them
  Real gap;    ///< [m], where they do not touch
  Real cell;   ///< mean edge length of the cells there [m]
};

/// Appends the nodes that get mass from particles of a cell; a node may be named more than once.
using NodesOfCell = std::function<void(Index cell, std::vector<Index>& nodes)>;

/// All pairs of bodies that share nodes, by their numbers.
template <int D>
std::vector<SharedNodes> find_shared_nodes(const Mesh<D>& mesh, const Particles<D>& particles, const std::vector<Body>& bodies,
                                           const NodesOfCell& nodes_of);

/// A sentence for each pair that does not touch.
std::vector<std::string> warnings_of(const std::vector<SharedNodes>& pairs, const std::vector<Body>& bodies);
/// One line about all pairs that touch, or nothing.
std::string contacts_in_words(const std::vector<SharedNodes>& pairs, const std::vector<Body>& bodies);

/// Cells that hold particles of two bodies at once: material there is counted twice, unless the shapes only touch.  Bodies in contact are left out (check_overlaps()).  A line for each pair, of ten at
/// most and then their number: a list of thousands is of no use.  cell: of each particle; every rank has to ask.
void warn_of_shared_cells(const Scene& scene, const std::vector<Body>& bodies, std::span<const Index> cell, Index n_cells,
                          Communicator& ranks, std::vector<std::string>& warnings);

/// A group of cells is filled by one body at a time.  Of several that fill it before a body, the first is named.
void find_groups_filled_twice(const Scene& scene, SceneErrorCollector& errors);

}  // namespace talus
