// Sparse operators over the one-ring: transposition, and the lumped L2 projection.
#include "kernels/node_operators.hpp"

#include <algorithm>
#include <cassert>

namespace talus {
namespace {

/// Entry of node v in the ring of n.  The ring is ascending and holds v.
std::size_t entry_of(const Csr& ring, Index n, Index v)
{
  const auto nodes = ring[n];
  const auto found = std::lower_bound(nodes.begin(), nodes.end(), v);
  assert(found != nodes.end() && *found == v);
  return static_cast<std::size_t>(ring.begin[static_cast<std::size_t>(n)]) + static_cast<std::size_t>(found - nodes.begin());
}

template <class Entry>
std::vector<Entry> transposed(const Csr& ring, const std::vector<Entry>& rows)
{
  std::vector<Entry> columns(rows.size());
  parallel_for(ring.size(), [&](Index v) {
    auto to = static_cast<std::size_t>(ring.begin[static_cast<std::size_t>(v)]);
    for (const Index n : ring[v])
      columns[to++] = rows[entry_of(ring, n, v)];
  });
  return columns;
}

}  // namespace

template <int D>
NodeOperators<D>::NodeOperators(const Mesh<D>& mesh, std::vector<Real> S, std::vector<Vec<D>> gradients)
    : ring_(mesh.ring_of_node()), S_row_(std::move(S)), D_row_(std::move(gradients))
{
  assert(S_row_.size() == ring_.item.size() && D_row_.size() == ring_.item.size());
  S_column_ = transposed(ring_, S_row_);
  D_column_ = transposed(ring_, D_row_);
}

template <int D>
std::vector<Real> hat_volumes(const Mesh<D>& mesh)
{
  std::vector<Real> volumes(static_cast<std::size_t>(mesh.n_nodes()));
  for_each_node(std::span<Real>(volumes), [&](Index n) {
    Real volume = 0;
    for (const Index c : mesh.cells_of_node()[n])
      volume += mesh.volume(c) / (D + 1);
    return volume;
  });
  return volumes;
}

template <int D>
NodeOperators<D> lumped_l2(const Mesh<D>& mesh)
{
  const Csr& ring = mesh.ring_of_node();
  const auto volumes = hat_volumes(mesh);
  std::vector<Real> S(ring.item.size(), 0.0);
  std::vector<Vec<D>> gradients(ring.item.size(), Vec<D>::Zero());
  parallel_for(mesh.n_nodes(), [&](Index n) {
    const Real hat = volumes[static_cast<std::size_t>(n)];
    for (const Index c : mesh.cells_of_node()[n]) {
      const auto slopes = mesh.gradients(c);
      const Real share = mesh.volume(c) / ((D + 1) * hat);  // int over c of N_n, of V_n
      for (std::size_t a = 0; a <= D; ++a) {
        const Index v = mesh.cell(c)[a];
        const std::size_t entry = entry_of(ring, n, v);
        S[entry] += share * (v == n ? 2.0 : 1.0) / (D + 2);  // int N_n N_v = |c| (1 + [n = v]) / ((D+1)(D+2))
        gradients[entry] += share * slopes[a];
      }
    }
  });
  return NodeOperators<D>(mesh, std::move(S), std::move(gradients));
}

template class NodeOperators<2>;
template class NodeOperators<3>;
template std::vector<Real> hat_volumes(const Mesh<2>&);
template std::vector<Real> hat_volumes(const Mesh<3>&);
template NodeOperators<2> lumped_l2(const Mesh<2>&);
template NodeOperators<3> lumped_l2(const Mesh<3>&);

}  // namespace talus
