#pragma once
// Values of moving least squares with the gradient of `projected`: a smooth mass, and a uniform stress that pulls at no interior node.
#include "kernels/node_operators.hpp"
#include "kernels/umls.hpp"
#include "kernels/value_stencils.hpp"

namespace talus {

/// With the values of Umls and, over the vertices n of the cell, the hats N_n and the averaged gradient D (kernels/node_operators.hpp):
///
///     w_v(x) = w_v of Umls          G_v(x) = sum_n N_n(x) D_nv
///
/// Exact for linear fields in values and gradients everywhere, and int G_v dx = 0 for interior v on any mesh.
template <int D>
class UmlsProjected {
 public:
  static constexpr std::string_view name = "umls_projected";
  static constexpr std::string_view summary = "values of umls, gradient of projected; continuous, exact for uniform stress";
  static constexpr int max_nodes = Umls<D>::max_nodes;
  static constexpr bool own_values = true;
  using Cell = typename Umls<D>::Cell;

  /// Throws std::invalid_argument as Umls does.
  explicit UmlsProjected(const Mesh<D>& mesh) : values_(mesh), node_part_(mesh, identity_values(mesh), averaged_gradients(mesh)) {}

  Claims claims() const noexcept
  {
    return {.non_negative = false,
            .linear_values = true,
            .linear_gradients = true,
            .continuous_values = true,
            .continuous_gradient = true,
            .gradient_of_values = false,
            .patch_test = true,
            .closed_walls = false};
  }
  std::span<const Index> stencil(const Mesh<D>& mesh, Index c) const noexcept { return values_.stencil(mesh, c); }
  void open(const Mesh<D>& mesh, Index c, Cell& cell) const noexcept { values_.open(mesh, c, cell); }
  void evaluate(const Cell& cell, const Pack (&x)[D], int count, Weights<D, max_nodes>& out) const noexcept
  {
    values_.evaluate(cell, x, count, out);
  }
  const NodeOperators<D>& node_operators() const noexcept { return node_part_; }

 private:
  Umls<D> values_;
  NodeOperators<D> node_part_;
};

static_assert(Kernel<UmlsProjected<2>, 2> && Kernel<UmlsProjected<3>, 3>);
static_assert(HasOwnValues<UmlsProjected<2>, 2> && HasOwnValues<UmlsProjected<3>, 3>);

}  // namespace talus
