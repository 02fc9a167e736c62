#pragma once
// Boxes with facets inside that are to be cut.
#include <functional>
#include <set>

#include "mesh/simplex.hpp"
#include "tests/mesh/rough_box.hpp"

namespace talus {

/// Adds the facets of a mesh whose nodes all fulfil a condition as a group.
template <int D>
void add_facets(MeshData<D>& data, const std::string& name, const std::function<bool(const Vec<D>&)>& holds)
{
  std::set<std::array<Index, D>> facets;
  for (const auto& cell : data.cells)
    for (std::size_t a = 0; a <= D; ++a) {
      std::array<Index, D> facet;
      for (std::size_t i = 0; i < D; ++i)
        facet[i] = cell[static_cast<std::size_t>(facet_locals<D>[a][i])];
      std::ranges::sort(facet);
      if (std::ranges::all_of(facet, [&](Index n) { return holds(data.nodes[static_cast<std::size_t>(n)]); }))
        facets.insert(facet);
    }
  data.facet_sets[name].assign(facets.begin(), facets.end());
}

/// A unit box with a flat group "cut" halfway up, from the side x = 0 to x = `end`; the other nodes are moved at random.
template <int D>
MeshData<D> cut_box(Index n, Real end, Real jitter = 0)
{
  std::array<Index, D> cells;
  cells.fill(n);
  MeshData<D> data = box<D>(Vec<D>::Zero(), Vec<D>::Ones(), cells);
  const auto lies_on = [&](const Vec<D>& x) { return std::abs(x[D - 1] - 0.5) < 1e-9 && x[0] < end + 1e-9; };
  add_facets<D>(data, "cut", lies_on);
  if (jitter == 0)
    return data;
  MeshData<D> moved = jittered(data, jitter, 7, BoundaryNodes::slide);
  for (std::size_t i = 0; i < moved.nodes.size(); ++i)
    if (lies_on(data.nodes[i]))
      moved.nodes[i][D - 1] = 0.5;
  return moved;
}

/// The mesh cut along these groups.
template <int D>
Mesh<D> cut_along(MeshData<D> data, const std::vector<std::string>& groups = {"cut"})
{
  return Mesh<D>(Mesh<D>(std::move(data)), groups);
}

}  // namespace talus
