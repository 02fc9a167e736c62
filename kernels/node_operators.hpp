#pragma once
// Node operators of a kernel: sparse operators over the one-ring, applied to nodal rows after the scatter and before the gather.
#include "core/parallel/threads.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// Node-to-node operators on the pattern of the one-ring: S_nv for values and D_nv [1/m] for gradients, where n is the node of a linear
/// shape function (which particles use) and v a node of the unknowns (which have mass and momentum).  The gather uses rows, the scatter
/// columns; both are stored from the same numbers, so that one is bitwise the transpose of the other.  Sums run over the ring in ascending
/// order.
template <int D>
class NodeOperators {
 public:
  /// Rows of S and of D on the entries of mesh.ring_of_node().
  NodeOperators(const Mesh<D>& mesh, std::vector<Real> S, std::vector<Vec<D>> gradients);

  /// sum_v S_nv x_v [m], the centre of the weights of linear shape function n; equal to x_n where S is exact for linear fields.
  const Vec<D>& centre(Index n) const noexcept { return centre_[static_cast<std::size_t>(n)]; }

  Index n_nodes() const noexcept { return ring_.size(); }
  std::size_t size_bytes() const noexcept
  {
    return ring_.item.size() * (sizeof(Index) + 2 * sizeof(Real) + 2 * sizeof(Vec<D>)) + centre_.size() * (sizeof(Index) + sizeof(Vec<D>));
  }

  /// Calls f(v, S_nv, D_nv) for the row of n.
  template <class F>
  void for_each_in_row(Index n, F&& f) const noexcept
  {
    visit(n, S_row_, D_row_, f);
  }
  /// Calls f(n, S_nv, D_nv) for the column of v.
  template <class F>
  void for_each_in_column(Index v, F&& f) const noexcept
  {
    visit(v, S_column_, D_column_, f);
  }

 private:
  template <class F>
  void visit(Index row, const std::vector<Real>& S, const std::vector<Vec<D>>& gradients, F& f) const noexcept
  {
    auto entry = static_cast<std::size_t>(ring_.begin[static_cast<std::size_t>(row)]);
    for (const Index i : ring_[row]) {
      f(i, S[entry], gradients[entry]);
      ++entry;
    }
  }

  Csr ring_;
  std::vector<Real> S_row_, S_column_;
  std::vector<Vec<D>> D_row_, D_column_, centre_;
};

/// The volume-averaged gradient of the linear shape functions N at nodes, with V_n = int N_n dx:
///
///     D_nv = int N_n grad N_v dx / V_n [1/m]
///
/// Rows sum to zero and give the slope of linear fields exactly, and sum_n V_n D_nv = int grad N_v dx, which is zero for interior v: a
/// uniform stress pulls at no interior node, on any mesh.
template <int D>
std::vector<Vec<D>> averaged_gradients(const Mesh<D>& mesh);

/// The index of node v in the row of n.  Rings are ascending and contain v.
std::size_t entry_of(const Csr& ring, Index n, Index v);

/// The lumped volumes V_n = int N_n dx [m^D].
template <int D>
std::vector<Real> hat_volumes(const Mesh<D>& mesh);

/// Sets out_i = f(i) for every node, in parallel.
template <class T, class F>
void for_each_node(std::span<T> out, F&& f)
{
  parallel_for(static_cast<Index>(out.size()), [&](Index i) { out[static_cast<std::size_t>(i)] = f(i); });
}

extern template class NodeOperators<2>;
extern template class NodeOperators<3>;

}  // namespace talus
