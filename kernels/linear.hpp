#pragma once
// Linear shape functions of the mesh, with which every other kernel is compared.
#include "kernels/kernel.hpp"

namespace talus {

/// Linear (P1) shape functions: w_a = barycentric coordinate a of the particle, G_a its gradient, constant in the cell.
/// Cheap, and exact for uniform stress on any mesh; but the gradient jumps where a particle crosses a facet.
template <int D>
class Linear {
 public:
  static constexpr std::string_view name = "linear";
  static constexpr std::string_view summary = "piecewise linear shape functions; cheapest, gradient jumps between cells";
  static constexpr int max_nodes = padded(D + 1);
  static constexpr bool weighs_vertices = true;

  /// The origin is the centroid, so w_a = 1 / (D + 1) + G_a . (x - origin).
  struct Cell : StencilCell<D, max_nodes> {
    alignas(64) Real dw[D][max_nodes];
  };

  explicit Linear(const Mesh<D>&) {}

  Claims claims() const noexcept
  {
    return {.non_negative = true,
            .linear_values = true,
            .linear_gradients = true,
            .continuous_values = true,
            .continuous_gradient = false,
            .gradient_of_values = true,
            .patch_test = true,
            .closed_walls = true};
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
      const Vec<D>& at = mesh.node(cell.nodes[real ? static_cast<std::size_t>(a) : 0]);
      for (int d = 0; d < D; ++d) {
        cell.x[d][a] = at[d] - cell.origin[d];
        cell.dw[d][a] = real ? gradients[static_cast<std::size_t>(a)][d] : 0;
      }
    }
  }

  /// Factors y_a = G_a, H = I.
  void evaluate(const Cell& cell, const Pack (&x)[D], int, Weights<D, max_nodes>& out) const noexcept
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
      out.slope[d] = cell.origin[d] - x[d];
      out.shift[d] = Pack{};
    }
  }
};

static_assert(Kernel<Linear<2>, 2> && Kernel<Linear<3>, 3>);

}  // namespace talus
