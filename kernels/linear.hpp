#pragma once
// The hats of the mesh: what every other kernel is compared with.
#include "kernels/kernel.hpp"

namespace talus {

/// P1 hat functions: w_a = barycentric coordinate a of the particle, G_a its gradient, constant in the cell.
/// Cheap, and exact for uniform stress on any mesh; but the gradient jumps where a particle crosses a facet.
template <int D>
class Linear {
 public:
  static constexpr std::string_view name = "linear";
  static constexpr std::string_view summary = "piecewise linear hats; cheapest, gradient jumps between cells";
  static constexpr int max_nodes = padded(D + 1);

  /// The affine map x -> barycentric coordinates, w_a = w_a(origin) + G_a . (x - origin), with origin = vertex 0.
  struct Cell : StencilCell<D, max_nodes> {
    Vec<D> origin;
    alignas(64) Real w_origin[max_nodes];
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
    cell.origin = mesh.node(cell.nodes[0]);
    const auto gradients = mesh.gradients(c);
    for (int a = 0; a < max_nodes; ++a) {
      const bool real = a <= D;
      const Vec<D>& at = mesh.node(cell.nodes[real ? static_cast<std::size_t>(a) : 0]);
      cell.w_origin[a] = a == 0 ? 1 : 0;
      for (int d = 0; d < D; ++d) {
        cell.x[d][a] = at[d];
        cell.dw[d][a] = real ? gradients[static_cast<std::size_t>(a)][d] : 0;
      }
    }
  }

  void evaluate(const Cell& cell, const Vec<D>& x, Weights<D, max_nodes>& out) const noexcept
  {
    Real r[D];
    for (int d = 0; d < D; ++d)
      r[d] = x[d] - cell.origin[d];
#pragma omp simd
    for (int a = 0; a < max_nodes; ++a) {
      Real w = cell.w_origin[a];
      for (int d = 0; d < D; ++d) {
        w += cell.dw[d][a] * r[d];
        out.dw[d][a] = cell.dw[d][a];
      }
      out.w[a] = w;
    }
  }
};

static_assert(Kernel<Linear<2>, 2> && Kernel<Linear<3>, 3>);

}  // namespace talus
