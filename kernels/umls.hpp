#pragma once
// Unstructured moving least squares (Cao et al., arXiv 2312.10338): weights over the one-ring of a cell's vertices.
#include "kernels/kernel.hpp"
#include "kernels/kernel_options.hpp"

namespace talus {

/// Moving least squares with sample weights W_v(x) = eta_v(x) d(|x_v - x| / R(x)).
///
/// eta_v is the sum of the barycentric coordinates of the vertices of the cell that are adjacent to v (or are v); with it the weight of a
/// node vanishes before the particle enters a cell whose stencil does not contain the node.  d is the quadratic B-spline of support 1.5 R,
/// and R(x) interpolates a radius R_v per vertex.  Values and gradients are the least-squares estimate of a linear field and of its
/// gradient at x, in the centred form: with r_v = x_v - x,
///
///     W0 = sum W_v     c = sum W_v r_v / W0     S = sum W_v (r_v - c)(r_v - c)^T
///     G_v = W_v S^-1 (r_v - c)                  w_v = W_v / W0 - c . G_v
///
/// R_v = h_v (mean length of the edges at v), times 1.25 or 1.5 for vertices of cells with a badly conditioned S, determined once.  If S is
/// still singular, the particle uses the linear shape functions of its cell.  Linear fields are exact in either case.
template <int D>
class Umls {
 public:
  static constexpr std::string_view name = "umls";
  static constexpr std::string_view summary = "moving least squares over the one-ring; gradient continuous between cells";
  static constexpr int max_nodes = D == 2 ? 48 : 128;
  using Options = UmlsOptions;

  struct Cell : StencilCell<D, max_nodes> {
    Real radius, radius_slope[D];                 ///< R at the origin, the centroid of the cell [m]; grad R [-]
    alignas(64) Real slope[D][pack_size];         ///< gradients [1/m] of the barycentric coordinates of all vertices; padding 0
    alignas(64) Real adjacent[D + 1][max_nodes];  ///< 1 where the node is adjacent to the vertex, else 0; padding 0
  };

  /// Throws std::invalid_argument if the stencil of a cell has more than max_nodes nodes.
  explicit Umls(const Mesh<D>& mesh, const Options& options = {});

  Claims claims() const noexcept
  {
    return {.non_negative = false,
            .linear_values = true,
            .linear_gradients = true,
            .continuous_values = true,
            .continuous_gradient = true,
            .gradient_of_values = false,
            .patch_test = false,
            .closed_walls = false};
  }

  /// The vertices of the cell in their order, then the other nodes of the ring.
  std::span<const Index> stencil(const Mesh<D>&, Index c) const noexcept { return stencil_[c]; }
  void open(const Mesh<D>& mesh, Index c, Cell& cell) const noexcept;
  void evaluate(const Cell& cell, const Pack (&x)[D], int count, Weights<D, max_nodes>& out) const noexcept;

  bool pairs_force_with_slopes() const noexcept { return gradient_ == UmlsGradient::exact_force; }
  /// grad w_v [1/m] of one lane from its weights, for their padded size.  Discontinuous at faces, like the gradient of eta.
  void slopes_of_values(const Cell& cell, const Pack (&x)[D], int lane, const Weights<D, max_nodes>& weights,
                        Real (&slopes)[D][max_nodes]) const noexcept;

  Real radius(Index node) const noexcept { return radius_[static_cast<std::size_t>(node)]; }  ///< R_v [m]

  /// The isotropy of S at x, D^D det S / tr(S)^D: 1 if all directions have equal weight, 0 if S is singular.
  Real roundness(const Cell& cell, const Vec<D>& x) const noexcept;
  /// Radii are enlarged where the isotropy is below the first value; below the second linear shape functions replace the estimate.
  static constexpr Real poor_roundness = 0.02, unusable_roundness = 1e-6;

 private:
  void build_stencils(const Mesh<D>& mesh);
  void choose_radii(const Mesh<D>& mesh);
  bool poor(const Mesh<D>& mesh, Index c) const noexcept;

  Csr stencil_;
  std::vector<std::uint8_t> adjacency_;  ///< for each entry of stencil_: bit a is set if the node is adjacent to vertex a of the cell
  std::vector<Real> radius_;             ///< radius of each node [m]
  UmlsGradient gradient_;
};

extern template class Umls<2>;
extern template class Umls<3>;
static_assert(Kernel<Umls<2>, 2> && Kernel<Umls<3>, 3> && HasSlopesOfValues<Umls<2>, 2> && HasSlopesOfValues<Umls<3>, 3>);

}  // namespace talus
