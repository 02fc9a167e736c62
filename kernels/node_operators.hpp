#pragma once
// The node part of a kernel: sparse operators over the one-ring, applied to nodal rows after the scatter and before the gather.
#include "core/parallel.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// Node-to-node operators on the pattern of the one-ring: S_nv for values, D_nv [1/m] for gradients, n the node of a hat (what
/// particles see), v the node of the unknowns (where mass and momentum live).  Rows serve the gather, columns the scatter; both are
/// stored, from the same numbers, so that one is the transpose of the other to the bit.  Sums run over the ring in ascending order.
///
/// For T = Real or a fixed-size Eigen type, with arrays of one T per node:
///
///     values(n, a)     = sum_v S_nv a_v            value_sums(v, b)    = sum_n S_nv b_n          (the transpose)
///     gradient(n, a)   = sum_v a_v (x) D_nv        gradient_sums(v, T) = sum_n T_n D_nv          (the transpose)
template <int D>
class NodeOperators {
 public:
  /// Rows of S and of D on the entries of mesh.ring_of_node().
  NodeOperators(const Mesh<D>& mesh, std::vector<Real> S, std::vector<Vec<D>> gradients);

  /// sum_v S_nv x_v [m]: where the weights of hat n see their mass; x_n itself where S is exact for linear fields.
  const Vec<D>& centre(Index n) const noexcept { return centre_[static_cast<std::size_t>(n)]; }

  Index n_nodes() const noexcept { return ring_.size(); }
  std::span<const Index> ring(Index n) const noexcept { return ring_[n]; }  ///< ascending, n itself included
  std::span<const Real> S_row(Index n) const noexcept { return part(S_row_, n); }
  std::span<const Vec<D>> D_row(Index n) const noexcept { return part(D_row_, n); }
  std::span<const Real> S_column(Index v) const noexcept { return part(S_column_, v); }  ///< over the ring of v: S_nv for its n
  std::span<const Vec<D>> D_column(Index v) const noexcept { return part(D_column_, v); }

  template <class T>
  T values(Index n, std::span<const T> a) const noexcept
  {
    return combine<T>(n, S_row(n), [&](Real s, Index v) -> T { return s * at(a, v); });
  }
  template <class T>
  T value_sums(Index v, std::span<const T> b) const noexcept
  {
    return combine<T>(v, S_column(v), [&](Real s, Index n) -> T { return s * at(b, n); });
  }
  /// (i, j) = d a_i / d x_j [unit of a / m]
  Mat<D> gradient(Index n, std::span<const Vec<D>> a) const noexcept
  {
    return combine<Mat<D>>(n, D_row(n), [&](const Vec<D>& d, Index v) -> Mat<D> { return at(a, v) * d.transpose(); });
  }
  Vec<D> gradient_sums(Index v, std::span<const Mat<D>> T) const noexcept
  {
    return combine<Vec<D>>(v, D_column(v), [&](const Vec<D>& d, Index n) -> Vec<D> { return at(T, n) * d; });
  }

 private:
  template <class Entry>
  std::span<const Entry> part(const std::vector<Entry>& entries, Index row) const noexcept
  {
    const auto first = static_cast<std::size_t>(ring_.begin[static_cast<std::size_t>(row)]);
    return {entries.data() + first, ring_[row].size()};
  }
  template <class T>
  static const T& at(std::span<const T> a, Index i) noexcept
  {
    return a[static_cast<std::size_t>(i)];
  }
  template <class T, class Entry, class Term>
  T combine(Index row, std::span<const Entry> entries, Term&& term) const noexcept
  {
    const auto nodes = ring_[row];
    T total = term(entries[0], nodes[0]);
    for (std::size_t i = 1; i < nodes.size(); ++i)
      total += term(entries[i], nodes[i]);
    return total;
  }

  Csr ring_;
  std::vector<Real> S_row_, S_column_;
  std::vector<Vec<D>> D_row_, D_column_, centre_;
};

/// The volume-averaged gradient of the hats N at nodes, with V_n = int N_n dx:
///
///     D_nv = int N_n grad N_v dx / V_n [1/m]
///
/// Rows sum to zero and give the slope of linear fields exactly, and sum_n V_n D_nv = int grad N_v dx, which is zero for interior v: a
/// uniform stress pulls at no interior node, on any mesh.
template <int D>
std::vector<Vec<D>> averaged_gradients(const Mesh<D>& mesh);

/// Entry of node v in the row of n.  Rings are ascending and hold v.
std::size_t entry_of(const Csr& ring, Index n, Index v);

/// f(n, c, a, entry) for every node n, every cell c around it and every vertex a of c: `entry` is that of cell(c)[a] in the row of n.
/// Rows in parallel.
template <int D, class F>
void for_each_cell_of_ring(const Mesh<D>& mesh, F&& f)
{
  const Csr& ring = mesh.ring_of_node();
  parallel_for(mesh.n_nodes(), [&](Index n) {
    for (const Index c : mesh.cells_of_node()[n])
      for (std::size_t a = 0; a <= D; ++a)
        f(n, c, a, entry_of(ring, n, mesh.cell(c)[a]));
  });
}

/// V_n = int N_n dx [m^D]
template <int D>
std::vector<Real> hat_volumes(const Mesh<D>& mesh);

/// out_i = f(i) for every node, in parallel.
template <class T, class F>
void for_each_node(std::span<T> out, F&& f)
{
  parallel_for(static_cast<Index>(out.size()), [&](Index i) { out[static_cast<std::size_t>(i)] = f(i); });
}

extern template class NodeOperators<2>;
extern template class NodeOperators<3>;

}  // namespace talus
