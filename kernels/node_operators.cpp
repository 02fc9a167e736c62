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

/// For the entry of each v in the row of n, the entry of n in the row of v.  Rows that contain v come in the order in which the row of v
/// names them, so each takes the next entry of that row.
std::vector<Index> opposite_entries(const Csr& ring)
{
  std::vector<Index> opposite(ring.item.size()), next(ring.begin.begin(), ring.begin.end() - 1);
  for (std::size_t entry = 0; entry < ring.item.size(); ++entry)
    opposite[entry] = next[static_cast<std::size_t>(ring.item[entry])]++;
  return opposite;
}

template <class Entry>
std::vector<Entry> transposed(std::span<const Index> opposite, const std::vector<Entry>& rows)
{
  std::vector<Entry> columns(rows.size());
  parallel_for(static_cast<Index>(rows.size()), [&](Index entry) {
    const auto i = static_cast<std::size_t>(entry);
    columns[i] = rows[static_cast<std::size_t>(opposite[i])];
  });
  return columns;
}

}  // namespace

template <int D>
NodeOperators<D>::NodeOperators(const Mesh<D>& mesh, std::vector<Real> S, std::vector<Vec<D>> gradients)
    : ring_(mesh.ring_of_node()), S_row_(std::move(S)), D_row_(std::move(gradients))
{
  assert(S_row_.size() == ring_.item.size() && D_row_.size() == ring_.item.size());
  const std::vector<Index> opposite = opposite_entries(ring_);
  S_column_ = transposed(opposite, S_row_);
  D_column_ = transposed(opposite, D_row_);
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

/// The number of ranges of nodes computed side by side, each with an array of all nodes.
constexpr Index most_ranges = 16;

template <int D>
std::vector<Vec<D>> averaged_gradients(const Mesh<D>& mesh)
{
  const auto volumes = hat_volumes(mesh);
  const Csr& ring = mesh.ring_of_node();
  std::vector<Vec<D>> gradients(ring.item.size(), Vec<D>::Zero());
  const Index n_nodes = mesh.n_nodes(), ranges = std::min(threads(), most_ranges);
  const auto first_of = [&](Index range) { return static_cast<Index>(std::int64_t{n_nodes} * range / ranges); };
  // For each range, the entry of each node in the row of n, where it has one; allocated here, as threads must not throw.
  std::vector<std::vector<Index>> entries(static_cast<std::size_t>(ranges), std::vector<Index>(static_cast<std::size_t>(n_nodes)));
  parallel_for(ranges, [&](Index range) {
    std::vector<Index>& entry_in_row = entries[static_cast<std::size_t>(range)];
    for (Index n = first_of(range); n < first_of(range + 1); ++n) {
      Index entry = ring.begin[static_cast<std::size_t>(n)];
      for (const Index v : ring[n])
        entry_in_row[static_cast<std::size_t>(v)] = entry++;
      for (const Index c : mesh.cells_of_node()[n])
        for (std::size_t a = 0; a <= D; ++a)
          gradients[static_cast<std::size_t>(entry_in_row[static_cast<std::size_t>(mesh.cell(c)[a])])] +=
              mesh.volume(c) / ((D + 1) * volumes[static_cast<std::size_t>(n)]) * mesh.gradients(c)[a];
    }
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
