// Sparse operators over the one-ring: transposition, and the averaged gradient.
#include "kernels/node_operators.hpp"

#include <algorithm>
#include <cassert>

namespace talus {

std::size_t entry_of(const Csr& ring, Index n, Index v)
{
  const auto nodes = ring[n];
  const auto found = std::lower_bound(nodes.begin(), nodes.end(), v);
  assert(found != nodes.end() && *found == v);
  return static_cast<std::size_t>(ring.begin[static_cast<std::size_t>(n)]) + static_cast<std::size_t>(found - nodes.begin());
}

namespace {

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
  centre_.resize(static_cast<std::size_t>(mesh.n_nodes()));
  for_each_node(std::span<Vec<D>>(centre_), [&](Index n) {
    Vec<D> centre = Vec<D>::Zero();
    for_each_in_row(n, [&](Index v, Real S_nv, const Vec<D>&) { centre += S_nv * mesh.node(v); });
    return centre;
  });
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
std::vector<Vec<D>> averaged_gradients(const Mesh<D>& mesh)
{
  const auto volumes = hat_volumes(mesh);
  std::vector<Vec<D>> gradients(mesh.ring_of_node().item.size(), Vec<D>::Zero());
  for_each_cell_of_ring(mesh, [&](Index n, Index c, std::size_t a, std::size_t entry) {
    gradients[entry] += mesh.volume(c) / ((D + 1) * volumes[static_cast<std::size_t>(n)]) * mesh.gradients(c)[a];
  });
  return gradients;
}

template class NodeOperators<2>;
template class NodeOperators<3>;
template std::vector<Real> hat_volumes(const Mesh<2>&);
template std::vector<Real> hat_volumes(const Mesh<3>&);
template std::vector<Vec<2>> averaged_gradients(const Mesh<2>&);
template std::vector<Vec<3>> averaged_gradients(const Mesh<3>&);

}  // namespace talus
