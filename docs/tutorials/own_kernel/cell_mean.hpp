#pragma once
// Equal weights for the vertices of the cell: the roughest kernel that moves mass and force.
#include <algorithm>

#include "kernels/kernel.hpp"

namespace talus {

/// w_a = 1 / (D+1) wherever the particle is in its cell, G_a the gradient of the linear shape function.
template <int D>
class CellMean {
 public:
  static constexpr std::string_view name = "cell_mean";
  static constexpr std::string_view summary = "equal weights in a cell; values jump between cells";
  static constexpr int max_nodes = padded(D + 1);

  struct Cell : StencilCell<D, max_nodes> {
    alignas(64) Real dw[D][max_nodes];
  };

  explicit CellMean(const Mesh<D>&) {}

  Claims claims() const noexcept
  {
    return {.non_negative = true,
            .linear_values = false,
            .linear_gradients = true,
            .continuous_values = false,
            .continuous_gradient = false,
            .gradient_of_values = false,
            .patch_test = true,
            .closed_walls = false};
  }

  std::span<const Index> stencil(const Mesh<D>& mesh, Index c) const noexcept { return mesh.cell(c); }

  void open(const Mesh<D>& mesh, Index c, Cell& cell) const noexcept
  {
    cell.cell = c;
    cell.size = D + 1;
    cell.padded_size = max_nodes;
    cell.nodes = stencil(mesh, c);
    cell.origin = centroid(mesh, c);
    const auto& gradients = mesh.gradients(c);
    for (int a = 0; a < max_nodes; ++a) {
      const bool real = a <= D;
      const auto vertex = static_cast<std::size_t>(real ? a : 0);
      for (int d = 0; d < D; ++d) {
        cell.x[d][a] = mesh.node(cell.nodes[vertex])[d] - cell.origin[d];
        cell.dw[d][a] = real ? gradients[vertex][d] : 0;
      }
    }
  }

  void evaluate(const Cell& cell, const Pack (&)[D], int, Weights<D, max_nodes>& out) const noexcept
  {
    for (int lane = 0; lane < pack_size; ++lane) {
      store(out.s[lane], D == 2 ? Pack{1, 1, 1, 0} : broadcast(1));
      out.padded_size[lane] = max_nodes;
      for (int d = 0; d < D; ++d)
        out.y[lane][d] = cell.dw[d];
    }
    out.value = broadcast(1.0 / (D + 1));
    out.H = {};
    for (int d = 0; d < D; ++d) {
      out.H.entry[d] = broadcast(1);
      out.slope[d] = out.shift[d] = Pack{};
    }
  }
};

}  // namespace talus
