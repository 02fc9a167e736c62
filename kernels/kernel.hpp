#pragma once
// What a kernel is: the weights with which a particle sees nodes.  Scatter and gather know nothing else about it.
//
// A kernel has a cell part (weights of one particle over the stencil of its cell) and, if it wants one, a node part (sparse
// operators over the one-ring, applied to nodal rows between scatter and gather; see node_operators.hpp).
#include <concepts>
#include <cstddef>
#include <string_view>

#include "core/lanes.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// Properties a kernel states; the contract tests prove each one, and show by example that what is not claimed does not hold.
struct Claims {
  bool non_negative;         ///< all values >= 0
  bool linear_values;        ///< sum w_v x_v = x
  bool linear_gradients;     ///< sum x_v (x) G_v = I
  bool continuous_values;    ///< same value from both sides of a facet
  bool continuous_gradient;  ///< same gradient from both sides of a facet
  bool gradient_of_values;   ///< G_v = grad w_v
  bool patch_test;           ///< int G_v dx = 0 for interior v
  bool closed_walls;         ///< on a boundary facet only its own nodes have weight
};

/// Values and gradients [1/m] of one particle over a stencil, as arrays of numbers; lives on the stack.
template <int D, int N>
struct Weights {
  alignas(64) Real w[N];
  alignas(64) Real dw[D][N];
};

/// What all particles of a cell share.  `K::Cell` is this or extends it.
template <int D, int N>
struct StencilCell {
  Index cell;
  int size;                       ///< nodes in the stencil
  int padded_size;                ///< rounded up to whole packs; entries beyond `size` carry zero weight
  std::span<const Index> nodes;   ///< their numbers
  alignas(64) Real x[D][N];       ///< their coordinates [m]; padding repeats the first node
};

/// A kernel on meshes of dimension D.  Tables are built once by the constructor; the mesh is an argument, never kept.
template <class K, int D>
concept Kernel = requires(const K k, const Mesh<D>& mesh, Index c, const Vec<D>& x, typename K::Cell& cell, Weights<D, K::max_nodes>& out) {
  { K::name } -> std::convertible_to<std::string_view>;
  { K::summary } -> std::convertible_to<std::string_view>;
  { K::max_nodes } -> std::convertible_to<int>;  // room for one stencil, whole packs; the constructor refuses a mesh that needs more
  K(mesh);                                       // may throw std::invalid_argument naming cell, place and number
  { k.claims() } noexcept -> std::same_as<Claims>;
  { k.stencil(mesh, c) } noexcept -> std::same_as<std::span<const Index>>;  // nodes: a function of the cell only
  { k.open(mesh, c, cell) } noexcept;                                 // fills what the particles of the cell share
  { k.evaluate(cell, x, out) } noexcept;                              // w and dw of a particle at x, padding zeroed
  requires K::max_nodes % pack_size == 0;
};

template <int D>
class NodeOperators;

/// A kernel with a node part: its weights are those of hats, and the operators stand between hats and unknowns.
template <class K, int D>
concept HasNodePart = requires(const K k) {
  { k.node_part() } noexcept -> std::same_as<const NodeOperators<D>&>;
};

}  // namespace talus
