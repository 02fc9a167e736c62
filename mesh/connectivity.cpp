#include "mesh/connectivity.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "core/parallel.hpp"

namespace talus {

namespace {

/// Distance along the Hilbert curve of a place on a grid of 2^bits per axis.  J. Skilling, Programming the Hilbert curve,
/// AIP Conf. Proc. 707 (2004) 381.
template <int D>
std::uint64_t hilbert_key(std::array<std::uint32_t, D> x, int bits) noexcept
{
  const std::uint32_t top = 1u << (bits - 1);
  for (std::uint32_t q = top; q > 1; q >>= 1) {
    const std::uint32_t below = q - 1;
    for (int d = 0; d < D; ++d) {
      if (x[d] & q) {
        x[0] ^= below;
      } else {
        const std::uint32_t swap = (x[0] ^ x[d]) & below;
        x[0] ^= swap;
        x[d] ^= swap;
      }
    }
  }
  for (int d = 1; d < D; ++d)
    x[d] ^= x[d - 1];
  std::uint32_t gray = 0;
  for (std::uint32_t q = top; q > 1; q >>= 1)
    if (x[D - 1] & q)
      gray ^= q - 1;
  std::uint64_t key = 0;
  for (int bit = bits - 1; bit >= 0; --bit)
    for (int d = 0; d < D; ++d)
      key = key << 1 | (((x[d] ^ gray) >> bit) & 1u);
  return key;
}

}  // namespace

template <int D>
std::vector<Index> hilbert_order(std::span<const Vec<D>> nodes, std::span<const std::array<Index, D + 1>> cells)
{
  constexpr int bits = D == 2 ? 30 : 20;
  Vec<D> low = nodes[cells[0][0]], high = low;
  for (const auto& cell : cells)
    for (const Index n : cell) {
      low = low.cwiseMin(nodes[n]);
      high = high.cwiseMax(nodes[n]);
    }
  // One scale for all axes: a cell of a long thin domain is as compact as one of a cube.
  const Real scale = ((1u << bits) - 1) / (high - low).maxCoeff();
  const Index n_cells = static_cast<Index>(cells.size());
  std::vector<std::pair<std::uint64_t, Index>> keys(cells.size());
  parallel_for(n_cells, [&](Index c) {
    Vec<D> sum = Vec<D>::Zero();
    for (const Index n : cells[c])
      sum += nodes[n] - low;
    std::array<std::uint32_t, D> place;
    for (int d = 0; d < D; ++d)
      place[d] = static_cast<std::uint32_t>(scale / (D + 1) * sum[d]);
    keys[c] = {hilbert_key<D>(place, bits), c};
  });
  std::sort(keys.begin(), keys.end());
  std::vector<Index> order(cells.size());
  for (Index c = 0; c < n_cells; ++c)
    order[c] = keys[c].second;
  return order;
}

template <int D>
FacetMatch<D> match_facets(std::span<const std::array<Index, D + 1>> cells, Index n_nodes)
{
  // Facets are thrown into the bucket of their lowest node; the few in a bucket are sorted.
  struct Claim {
    std::array<Index, D - 1> rest;
    Facet facet;
  };
  const Index n_cells = static_cast<Index>(cells.size());
  const auto for_each_claim = [&](auto&& f) {
    for (Index c = 0; c < n_cells; ++c)
      for (Index a = 0; a <= D; ++a) {
        std::array<Index, D> nodes;
        for (int i = 0; i < D; ++i)
          nodes[i] = cells[c][i < a ? i : i + 1];
        std::sort(nodes.begin(), nodes.end());
        f(nodes, Facet{c, a});
      }
  };
  std::vector<Index> begin(static_cast<std::size_t>(n_nodes) + 1, 0);
  for_each_claim([&](const auto& nodes, Facet) { ++begin[nodes[0] + 1]; });
  for (Index n = 0; n < n_nodes; ++n)
    begin[n + 1] += begin[n];
  std::vector<Claim> claims(cells.size() * (D + 1));
  std::vector<Index> next(begin.begin(), begin.end() - 1);
  for_each_claim([&](const auto& nodes, Facet facet) {
    Claim& claim = claims[next[nodes[0]]++];
    std::copy(nodes.begin() + 1, nodes.end(), claim.rest.begin());
    claim.facet = facet;
  });

  FacetMatch<D> match;
  match.neighbours.resize(cells.size());
  for (auto& row : match.neighbours)
    row.fill(none);
  for (Index n = 0; n < n_nodes; ++n) {
    const auto first = claims.begin() + begin[n], last = claims.begin() + begin[n + 1];
    std::sort(first, last, [](const Claim& a, const Claim& b) { return std::tie(a.rest, a.facet.cell) < std::tie(b.rest, b.facet.cell); });
    for (auto claim = first; claim != last;) {
      const auto end = std::find_if(claim, last, [&](const Claim& other) { return other.rest != claim->rest; });
      if (end - claim > 2) {
        match.crowded = {claim[0].facet, claim[1].facet, claim[2].facet};
        return match;
      }
      if (end - claim == 2) {
        const Facet a = claim[0].facet, b = claim[1].facet;
        match.neighbours[a.cell][a.local] = b.cell;
        match.neighbours[b.cell][b.local] = a.cell;
      }
      claim = end;
    }
  }
  return match;
}

template <int D>
Csr cells_at_nodes(std::span<const std::array<Index, D + 1>> cells, Index n_nodes)
{
  Csr at;
  at.begin.assign(static_cast<std::size_t>(n_nodes) + 1, 0);
  for (const auto& cell : cells)
    for (const Index n : cell)
      ++at.begin[n + 1];
  for (Index n = 0; n < n_nodes; ++n)
    at.begin[n + 1] += at.begin[n];
  at.item.resize(cells.size() * (D + 1));
  std::vector<Index> next(at.begin.begin(), at.begin.end() - 1);
  for (Index c = 0; c < static_cast<Index>(cells.size()); ++c)
    for (const Index n : cells[c])
      at.item[next[n]++] = c;
  return at;
}

template <int D>
Csr nodes_around(std::span<const std::array<Index, D + 1>> cells, const Csr& cells_of_node)
{
  const Index n_nodes = cells_of_node.size();
  Csr around;
  around.begin.reserve(static_cast<std::size_t>(n_nodes) + 1);
  around.item.reserve(static_cast<std::size_t>(n_nodes) * (D == 2 ? 7 : 15));  // typical size of a ring
  std::vector<Index> seen_by(n_nodes, none);
  for (Index n = 0; n < n_nodes; ++n) {
    const std::size_t first = around.item.size();
    for (const Index c : cells_of_node[n])
      for (const Index m : cells[c])
        if (std::exchange(seen_by[m], n) != n)
          around.item.push_back(m);
    std::sort(around.item.begin() + static_cast<std::ptrdiff_t>(first), around.item.end());
    around.begin.push_back(static_cast<Index>(around.item.size()));
  }
  return around;
}

template std::vector<Index> hilbert_order<2>(std::span<const Vec<2>>, std::span<const std::array<Index, 3>>);
template std::vector<Index> hilbert_order<3>(std::span<const Vec<3>>, std::span<const std::array<Index, 4>>);
template FacetMatch<2> match_facets<2>(std::span<const std::array<Index, 3>>, Index);
template FacetMatch<3> match_facets<3>(std::span<const std::array<Index, 4>>, Index);
template Csr cells_at_nodes<2>(std::span<const std::array<Index, 3>>, Index);
template Csr cells_at_nodes<3>(std::span<const std::array<Index, 4>>, Index);
template Csr nodes_around<2>(std::span<const std::array<Index, 3>>, const Csr&);
template Csr nodes_around<3>(std::span<const std::array<Index, 4>>, const Csr&);

}  // namespace talus
