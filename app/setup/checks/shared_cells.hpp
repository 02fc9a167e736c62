#pragma once
// Cells that two bodies fill at once.
#include <span>
#include <string>
#include <vector>

#include "app/setup/checks/scene_error_collector.hpp"
#include "core/parallel/communicator.hpp"
#include "io/scene/scene.hpp"
#include "solver/model/model.hpp"

namespace talus {

/// Cells that hold particles of two bodies at once: material there is counted twice, unless the shapes only touch.  A line for each pair, of ten at
/// most and then their number: a list of thousands is of no use.  cell: of each particle; every rank has to ask.
void warn_of_shared_cells(const Scene& scene, const std::vector<Body>& bodies, std::span<const Index> cell, Index n_cells,
                          Communicator& ranks, std::vector<std::string>& warnings);

/// A group of cells is filled by one body at a time.  Of several that fill it before a body, the first is named.
void find_groups_filled_twice(const Scene& scene, SceneErrorCollector& errors);

}  // namespace talus
