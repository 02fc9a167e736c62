#include "mesh/connectivity.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "core/parallel/parallel_sort.hpp"
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
      // Inverts the lower bits of x[0] where the bit is set, else exchanges them with those of x[d]; without a branch, which would be
      // mispredicted half of the time.
      const std::uint32_t is_set = (x[d] & q) != 0 ? below : 0;
      const std::uint32_t swap = (x[0] ^ x[d]) & below & ~is_set;
      x[0] ^= swap | is_set;
      x[d] ^= swap;
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
  parallel_sort(keys);
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

namespace {

/// A facet of a cell by its nodes other than the lowest one.
struct FacetClaim {
  std::uint64_t rest;  ///< these nodes, ascending, as one number
  Facet facet;
  friend bool operator<(const FacetClaim& a, const FacetClaim& b) noexcept
  {
    return std::tie(a.rest, a.facet.cell) < std::tie(b.rest, b.facet.cell);
  }
};

/// The nodes of the facet opposite local node `a`, other than n, as one number.
template <int D>
std::uint64_t rest_of_facet(const std::array<Index, D + 1>& cell, Index a, Index n) noexcept
{
  std::array<std::uint64_t, D - 1> rest{};
  std::size_t count = 0;
  for (Index i = 0; i <= D; ++i)
    if (i != a && cell[i] != n)
      rest[count++] = static_cast<std::uint64_t>(cell[i]);
  if constexpr (D == 2)
    return rest[0];
  else
    return std::min(rest[0], rest[1]) << 32 | std::max(rest[0], rest[1]);
}

/// Adds the facets of a cell whose lowest node is n: all at n if n is the lowest node of the cell, the one opposite the lowest node if n is
/// the second lowest, none otherwise.
template <int D>
void claim_facets(Index c, const std::array<Index, D + 1>& cell, Index n, std::vector<FacetClaim>& claims)
{
  Index below = 0, lowest = 0;  // number of nodes below n; local number of the lowest node
  for (Index i = 0; i <= D; ++i) {
    below += cell[i] < n ? 1 : 0;
    lowest = cell[i] < cell[lowest] ? i : lowest;
  }
  if (below == 1)
    claims.push_back({rest_of_facet<D>(cell, lowest, n), {c, lowest}});
  for (Index a = 0; a <= D && below == 0; ++a)
    if (a != lowest)
      claims.push_back({rest_of_facet<D>(cell, a, n), {c, a}});
}

}  // namespace

template <int D>
FacetMatch<D> match_facets(std::span<const std::array<Index, D + 1>> cells, const Csr& cells_of_node)
{
  FacetMatch<D> match;
  match.neighbours.resize(cells.size());
  for (auto& row : match.neighbours)
    row.fill(none);
  // Every facet is found from its lowest node, among the few other facets of that node: stores the neighbours across facets whose lowest
  // node is n; returns a facet that belongs to three cells, if there is one.
  using Three = std::array<Facet, 3>;
  const auto match_from = [&](Index n) -> std::optional<Three> {
    static thread_local std::vector<FacetClaim> claims;
    claims.clear();
    for (const Index c : cells_of_node[n])
      claim_facets<D>(c, cells[c], n, claims);
    std::sort(claims.begin(), claims.end());
    for (auto claim = claims.begin(); claim != claims.end();) {
      const auto end = std::find_if(claim, claims.end(), [&](const FacetClaim& other) { return other.rest != claim->rest; });
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
  constexpr Index most_ranges = 16;  // each needs an array of all nodes
  const Index ranges = std::min(threads(), most_ranges);
  const auto first_of = [&](Index range) { return static_cast<Index>(std::int64_t{n_nodes} * range / ranges); };
  // For each range, the last of its rings that has each node; allocated here, as are the usual rings: threads should not throw.
  std::vector<std::vector<Index>> lasts(static_cast<std::size_t>(ranges), std::vector<Index>(static_cast<std::size_t>(n_nodes), none));
  std::vector<std::vector<Index>> rings(static_cast<std::size_t>(ranges));  // of the nodes of each range, one after the other
  for (std::vector<Index>& ring : rings)
    ring.reserve(static_cast<std::size_t>(n_nodes / ranges + 1) * (D == 2 ? 8 : 18));
  Csr around;
  around.begin.assign(static_cast<std::size_t>(n_nodes) + 1, 0);
  parallel_for(ranges, [&](Index range) {
    std::vector<Index>& ring = rings[static_cast<std::size_t>(range)];
    std::vector<Index>& last = lasts[static_cast<std::size_t>(range)];
    for (Index n = first_of(range); n < first_of(range + 1); ++n) {
      const auto begin = static_cast<std::ptrdiff_t>(ring.size());
      for (const Index c : cells_of_node[n])
        for (const Index m : cells[c])
          if (std::exchange(last[m], n) != n)
            ring.push_back(m);
      std::sort(ring.begin() + begin, ring.end());
      around.begin[n + 1] = static_cast<Index>(static_cast<std::ptrdiff_t>(ring.size()) - begin);
    }
  });
  for (Index n = 0; n < n_nodes; ++n)
    around.begin[n + 1] += around.begin[n];
  around.item.resize(static_cast<std::size_t>(around.begin.back()));
  parallel_for(ranges, [&](Index range) {
    const std::vector<Index>& ring = rings[static_cast<std::size_t>(range)];
    std::copy(ring.begin(), ring.end(), around.item.begin() + around.begin[first_of(range)]);
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
