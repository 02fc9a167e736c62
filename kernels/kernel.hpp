#pragma once
// Definition of a kernel: the weights between a particle and nodes.  Transfers use nothing else of it.  A kernel has a cell part (weights
// of one particle over the stencil of its cell) and optionally a set of node operators (sparse operators over the one-ring, applied to
// nodal rows between scatter and gather; see node_operators.hpp).
#include <concepts>
#include <string_view>

#include "kernels/pack.hpp"
#include "kernels/symmetric.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// Properties of a kernel.  The contract tests check each claim, and show by example that properties that are not claimed do not hold.
struct Claims {
  bool non_negative;         ///< all values >= 0
  bool linear_values;        ///< sum w_v x_v = x
  bool linear_gradients;     ///< sum x_v (x) G_v = I
  bool continuous_values;    ///< equal values from both sides of a facet
  bool continuous_gradient;  ///< equal gradients from both sides of a facet
  bool gradient_of_values;   ///< G_v = grad w_v
  bool patch_test;           ///< int G_v dx = 0 for interior v
  bool closed_walls;         ///< on a boundary facet only its own nodes have weight
};

/// Values and gradients [1/m] of one particle over a stencil, node by node.
template <int D, int N>
struct NodeWeights {
  alignas(64) Real w[N];
  alignas(64) Real dw[D][N];
};

/// The weights of up to four particles of a cell as factors.  With s_v and y_v for each node, and the rest common to all nodes,
///
///     w_v = s_v (value - slope . y_v)        G_v = s_v (H y_v - shift)
///
/// H is symmetric.  Sums over a stencil then need products with s_v and s_v y_v only, and H is applied once per particle.  Lanes of packs
/// are particles; missing ones repeat the last particle.  Lives on the stack; y belongs to the open cell.
template <int D, int N>
struct Weights {
  alignas(64) Real s[pack_size][N];
  const Real* y[pack_size][D];  ///< per component the numbers of all nodes, aligned like s
  int padded_size[pack_size];   ///< number of nodes, in whole packs, that may have weight: the first ones of the stencil, or all
  Pack value, slope[D], shift[D];
  Symmetric<D, Pack> H;

  /// Computes the weights from the factors for one lane.
  void spell_out(int lane, NodeWeights<D, N>& out) const noexcept
  {
    out = {};
    for (int i = 0; i < padded_size[lane]; ++i) {
      const Real s_i = s[lane][i];
      out.w[i] = s_i * value[lane];
      for (int d = 0; d < D; ++d) {
        out.w[i] -= s_i * slope[d][lane] * y[lane][d][i];
        out.dw[d][i] = -s_i * shift[d][lane];
        for (int e = 0; e < D; ++e)
          out.dw[d][i] += s_i * H(d, e)[lane] * y[lane][e][i];
      }
    }
  }
};

/// Data shared by all particles of a cell.  `K::Cell` is this or extends it.
template <int D, int N>
struct StencilCell {
  Index cell;
  int size;                      ///< nodes in the stencil
  int padded_size;               ///< rounded up to whole packs; entries beyond `size` carry zero weight
  std::span<const Index> nodes;  ///< numbers of the nodes of the stencil
  Vec<D> origin;                 ///< a point of the cell [m]
  alignas(64) Real x[D][N];      ///< coordinates of the nodes relative to the origin [m]; padding repeats the first node
};

template <int D>
Vec<D> centroid(const Mesh<D>& mesh, Index c) noexcept
{
  Vec<D> sum = Vec<D>::Zero();
  for (const Index v : mesh.cell(c))
    sum += mesh.node(v);
  return sum / (D + 1);
}

// Version 14 of the formatter does not know requires-expressions.
// clang-format off
/// A kernel on meshes of dimension D.  The constructor builds its tables; the mesh is passed as an argument and never stored.
template <class K, int D>
concept Kernel = requires(const K k, const Mesh<D>& mesh, Index c, const Pack (&x)[D], typename K::Cell& cell, Weights<D, K::max_nodes>& out) {
  { K::name } -> std::convertible_to<std::string_view>;
  { K::summary } -> std::convertible_to<std::string_view>;
  { K::max_nodes } -> std::convertible_to<int>;  // room for one stencil, in whole packs; the constructor refuses a mesh that needs more
  K(mesh);                                       // may throw std::invalid_argument with cell, position and number
  { k.claims() } noexcept -> std::same_as<Claims>;
  { k.stencil(mesh, c) } noexcept -> std::same_as<std::span<const Index>>;  // nodes of the stencil, which depend on the cell only
  { k.open(mesh, c, cell) } noexcept;                                        // sets the data shared by the particles of the cell
  { k.evaluate(cell, x, 4, out) } noexcept;                                  // weights of up to four particles at x; s = 0 in the padding
  requires K::max_nodes % pack_size == 0;
};

/// The options of a kernel without keys in a scene; other kernels define K::Options.
struct NoOptions {};
template <class K>
struct OptionsOf {
  using type = NoOptions;
};
template <class K>
requires requires { typename K::Options; }
struct OptionsOf<K> {
  using type = typename K::Options;
};
template <class K>
using Options = typename OptionsOf<K>::type;
template <class K, int D>
K make_kernel(const Mesh<D>& mesh, [[maybe_unused]] const Options<K>& options)
{
  if constexpr (std::same_as<Options<K>, NoOptions>)
    return K(mesh);
  else
    return K(mesh, options);
}

template <int D>
class NodeOperators;

/// A kernel with node operators between linear shape functions and unknowns; its weights are those of linear shape functions.
template <class K, int D>
concept HasNodeOperators = requires(const K k) {
  { k.node_operators() } noexcept -> std::same_as<const NodeOperators<D>&>;
};

/// A kernel whose weights are the barycentric coordinates in the cell, and its stencil the vertices: linear shape functions, with or without
/// node operators.  Transfers then use neither open() nor evaluate().
template <class K, int D>
concept WeighsVertices = HasNodeOperators<K, D> || requires {
  requires K::weighs_vertices;
};

/// A kernel that can compute grad w_v [1/m] from given weights, with those up to weights.padded_size[lane] set, and may use it for the
/// force.
template <class K, int D>
concept HasSlopesOfValues = requires(const K k, const typename K::Cell& cell, const Pack (&x)[D], const Weights<D, K::max_nodes>& weights,
                                     Real (&slopes)[D][K::max_nodes]) {
  { k.pairs_force_with_slopes() } noexcept -> std::same_as<bool>;
  { k.slopes_of_values(cell, x, 0, weights, slopes) } noexcept;
};
// clang-format on

}  // namespace talus
