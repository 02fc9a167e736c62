#pragma once
// The kernel `projected`: linear shape functions at the particles and sparse operators at the nodes.  Its gradient is continuous and
// satisfies the integration constraint, at about the cost of linear shape functions.
#include "kernels/kernel_options.hpp"
#include "kernels/linear.hpp"
#include "kernels/node_operators.hpp"
#include "kernels/value_stencils.hpp"

namespace talus {

/// The kernel with the linear shape functions N_n of the cell's vertices, the values S of maximum entropy (kernels/value_stencils.hpp) and
/// the averaged gradient D (kernels/node_operators.hpp):
///
///     w_v(x) = sum_n N_n(x) S_nv          G_v(x) = sum_n N_n(x) D_nv
///
/// Both are continuous, sum G = 0 and sum x (x) G = I everywhere, and int G_v dx = 0 for interior v on any mesh.  Particles use linear
/// shape functions only: a scatter adds to the vertices of the cell, the transposed operators map these sums to the unknowns, and the
/// operators map the motion back.  A related method is the dual domain material point method [Zhang, Ma & Giguere 2011, J. Comput. Phys.
/// 230].
template <int D>
class Projected {
 public:
  static constexpr std::string_view name = "projected";
  static constexpr std::string_view summary =
      "linear shape functions with averaged nodal gradient and values; continuous gradient, exact for uniform stress";
  static constexpr int max_nodes = Linear<D>::max_nodes;
  using Cell = typename Linear<D>::Cell;
  using Options = ProjectedOptions;

  explicit Projected(const Mesh<D>& mesh, const Options& options = {});

  Claims claims() const noexcept
  {
    return {.non_negative = true,
            .linear_values = true,  // up to flat walls
            .linear_gradients = true,
            .continuous_values = true,
            .continuous_gradient = true,
            .gradient_of_values = false,
            .patch_test = true,
            .closed_walls = false};
  }
  /// The cell part: linear shape functions.
  std::span<const Index> stencil(const Mesh<D>& mesh, Index c) const noexcept { return linear_.stencil(mesh, c); }
  void open(const Mesh<D>& mesh, Index c, Cell& cell) const noexcept { linear_.open(mesh, c, cell); }
  void evaluate(const Cell& cell, const Pack (&x)[D], int count, Weights<D, max_nodes>& out) const noexcept
  {
    linear_.evaluate(cell, x, count, out);
  }
  /// Whether gradients at surfaces that cut cells take extended velocities.
  bool extends_surfaces() const noexcept { return extends_; }
  const NodeOperators<D>& node_operators() const noexcept { return node_part_; }
  /// Nodes without positive weights that are exact for linear fields, ascending; they are treated as corners.
  std::span<const Index> nodes_as_corners() const noexcept { return as_corners_; }

 private:
  Projected(const Mesh<D>& mesh, MaxentValues rows);

  bool extends_ = false;
  Linear<D> linear_;
  std::vector<Index> as_corners_;
  NodeOperators<D> node_part_;
};

extern template class Projected<2>;
extern template class Projected<3>;
static_assert(Kernel<Projected<2>, 2> && Kernel<Projected<3>, 3> && HasNodeOperators<Projected<2>, 2> && HasNodeOperators<Projected<3>, 3>);

}  // namespace talus
