#pragma once
// Sums over the stars of nodes by hats, for scalars that are averaged or conducted: cheap, and apart from the kernel of the momentum.
#include <algorithm>
#include <array>
#include <vector>

#include "core/parallel.hpp"
#include "mesh/mesh.hpp"
#include "solver/cell_order.hpp"

namespace talus {

/// Barycentric coordinates of x in cell c, for a particle that may just have left it: none negative, sum one.
template <int D>
std::array<Real, D + 1> hats_inside(const Mesh<D>& mesh, Index c, const Vec<D>& x) noexcept
{
  std::array<Real, D + 1> hats = mesh.barycentric(c, x);
  Real sum = 0;
  for (Real& hat : hats)
    sum += hat = std::max(hat, Real{0});
  for (Real& hat : hats)
    hat /= sum;
  return hats;
}

/// K sums per node.  Every cell keeps its own, which are then added up in ascending order of cells: the bits do not depend on threads.
template <int D, int K>
class StarSums {
 public:
  using Row = std::array<Real, K>;

  explicit StarSums(const Mesh<D>& mesh)
      : of_corner_(static_cast<std::size_t>(mesh.n_cells())), of_node_(static_cast<std::size_t>(mesh.n_nodes()))
  {}

  /// Clears, then add(cell, its particles, rows of its corners) for every cell that holds particles of the body.
  template <class Add>
  void gather(const Mesh<D>& mesh, const CellOrder& order, Index body, const Particles<D>& particles, Add&& add)
  {
    parallel_for(mesh.n_cells(), [&](Index c) { of_corner_[static_cast<std::size_t>(c)] = {}; });
    parallel_for_uneven(order.blocks, [&](Index block) {
      for_each_run(order.rows(body, block), particles.cell,
                   [&](Index c, std::span<const Index> run) { add(c, run, of_corner_[static_cast<std::size_t>(c)]); });
    });
    parallel_for(mesh.n_nodes(), [&](Index n) {
      Row total{};
      for (const Index c : mesh.cells_of_node()[n]) {
        const auto& cell = mesh.cell(c);
        const auto a = static_cast<std::size_t>(std::find(cell.begin(), cell.end(), n) - cell.begin());
        for (std::size_t k = 0; k < K; ++k)
          total[k] += of_corner_[static_cast<std::size_t>(c)][a][k];
      }
      of_node_[static_cast<std::size_t>(n)] = total;
    });
  }

  const Row& operator[](Index node) const noexcept { return of_node_[static_cast<std::size_t>(node)]; }

 private:
  std::vector<std::array<Row, D + 1>> of_corner_;
  std::vector<Row> of_node_;
};

}  // namespace talus
