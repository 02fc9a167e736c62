#include "mesh/connectivity.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "core/parallel/threads.hpp"

namespace talus {

namespace {

/// The distance along the Hilbert curve of a position on a grid of 2^bits per axis.  J. Skilling, Programming the Hilbert curve, AIP Conf.
/// Proc. 707 (2004) 381.
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
  // One scale for all axes, so that ranges of a long thin domain are as compact as those of a cube.
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
std::vector<Index> nodes_in_use(std::span<const std::array<Index, D + 1>> cells, std::span<const Index> chosen, Index n_nodes)
{
  std::vector<std::uint8_t> used(static_cast<std::size_t>(n_nodes), 0);
  for (const Index c : chosen)
    for (const Index n : cells[c])
      used[n] = 1;
  std::vector<Index> nodes;
  for (Index n = 0; n < n_nodes; ++n)
    if (used[n] != 0)
      nodes.push_back(n);
  return nodes;
}

template <int D>
FacetMatch<D> match_facets(std::span<const std::array<Index, D + 1>> cells, const Csr& cells_of_node)
{
  // Every facet is found from its lowest node, among the few other facets of that node.
  struct Claim {
    std::array<Index, D - 1> rest;
    Facet facet;
  };
  FacetMatch<D> match;
  match.neighbours.resize(cells.size());
  for (auto& row : match.neighbours)
    row.fill(none);
  // Stores the neighbours across facets whose lowest node is n; returns a facet that belongs to three cells, if there is one.
  using Three = std::array<Facet, 3>;
  const auto match_from = [&](Index n) -> std::optional<Three> {
    static thread_local std::vector<Claim> claims;
    claims.clear();
    for (const Index c : cells_of_node[n])
      for (Index a = 0; a <= D; ++a) {
        std::array<Index, D> nodes;
        for (int i = 0; i < D; ++i)
          nodes[i] = cells[c][i < a ? i : i + 1];
        std::sort(nodes.begin(), nodes.end());
        if (nodes[0] != n)
          continue;
        Claim& claim = claims.emplace_back();
        std::copy(nodes.begin() + 1, nodes.end(), claim.rest.begin());
        claim.facet = Facet{c, a};
      }
    std::sort(claims.begin(), claims.end(),
              [](const Claim& a, const Claim& b) { return std::tie(a.rest, a.facet.cell) < std::tie(b.rest, b.facet.cell); });
    for (auto claim = claims.begin(); claim != claims.end();) {
      const auto end = std::find_if(claim, claims.end(), [&](const Claim& other) { return other.rest != claim->rest; });
      if (end - claim > 2)
        return Three{claim[0].facet, claim[1].facet, claim[2].facet};
      if (end - claim == 2) {
        const Facet a = claim[0].facet, b = claim[1].facet;
        match.neighbours[a.cell][a.local] = b.cell;
        match.neighbours[b.cell][b.local] = a.cell;
      }
      claim = end;
    }
    return std::nullopt;
  };
  const Index n_nodes = cells_of_node.size();
  const auto first = static_cast<Index>(parallel_min(n_nodes, n_nodes, [&](Index n) { return match_from(n) ? n : n_nodes; }));
  if (first < n_nodes)
    match.crowded = match_from(first);
  return match;
}

template <int D>
Csr nodes_around(std::span<const std::array<Index, D + 1>> cells, const Csr& cells_of_node)
{
  const Index n_nodes = cells_of_node.size();
  const auto ring_of = [&](Index n, std::vector<Index>& ring) {
    ring.clear();
    for (const Index c : cells_of_node[n])
      ring.insert(ring.end(), cells[c].begin(), cells[c].end());
    std::sort(ring.begin(), ring.end());
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  };
  static thread_local std::vector<Index> ring;
  Csr around;
  around.begin.assign(static_cast<std::size_t>(n_nodes) + 1, 0);
  parallel_for(n_nodes, [&](Index n) {
    ring_of(n, ring);
    around.begin[n + 1] = static_cast<Index>(ring.size());
  });
  for (Index n = 0; n < n_nodes; ++n)
    around.begin[n + 1] += around.begin[n];
  around.item.resize(static_cast<std::size_t>(around.begin.back()));
  parallel_for(n_nodes, [&](Index n) {
    ring_of(n, ring);
    std::copy(ring.begin(), ring.end(), around.item.begin() + around.begin[n]);
  });
  return around;
}

template std::vector<Index> hilbert_order<2>(std::span<const Vec<2>>, std::span<const std::array<Index, 3>>);
template std::vector<Index> hilbert_order<3>(std::span<const Vec<3>>, std::span<const std::array<Index, 4>>);
template std::vector<Index> nodes_in_use<2>(std::span<const std::array<Index, 3>>, std::span<const Index>, Index);
template std::vector<Index> nodes_in_use<3>(std::span<const std::array<Index, 4>>, std::span<const Index>, Index);
template FacetMatch<2> match_facets<2>(std::span<const std::array<Index, 3>>, const Csr&);
template FacetMatch<3> match_facets<3>(std::span<const std::array<Index, 4>>, const Csr&);
template Csr cells_at_nodes<2>(std::span<const std::array<Index, 3>>, Index);
template Csr cells_at_nodes<3>(std::span<const std::array<Index, 4>>, Index);
template Csr nodes_around<2>(std::span<const std::array<Index, 3>>, const Csr&);
template Csr nodes_around<3>(std::span<const std::array<Index, 4>>, const Csr&);

}  // namespace talus
