#pragma once
// Sums of nodes that blocks of several ranks share.  Rows are sent to the rank that owns the node, which adds them in the order of blocks,
// as a single rank would.  The result is sent back to all ranks that use it.
#include <numeric>
#include <stdexcept>

#include "solver/halo/block_rows.hpp"
#include "solver/halo/halo_exchange.hpp"
#include "solver/state/owned_nodes.hpp"

namespace talus {

/// Messages from blocks to the owners of nodes: rows of own blocks on nodes of other ranks, by block and node.  Collective.
template <int D, class Sum>
std::vector<NeighbourRank> find_row_borders(Communicator& ranks, const Mesh<D>& mesh, const Subdomain& subdomain,
                                            const BlockRows<D, Sum>& blocks)
{
  const auto z = [](Index i) { return static_cast<std::size_t>(i); };
  std::vector<Index> node_of_row(blocks.row.size());
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    for (const Index r : blocks.rows_of_node[n])
      node_of_row[z(r)] = n;
  std::vector<NeighbourRank> all(static_cast<std::size_t>(ranks.size()));
  for (Index b = 0; b < blocks.size(); ++b) {
    std::vector<std::pair<Index, Index>> rows;  // node, row
    for (Index r = blocks.begin[z(b)]; r < blocks.begin[z(b) + 1]; ++r)
      rows.emplace_back(node_of_row[z(r)], r);
    std::sort(rows.begin(), rows.end());
    for (const auto& [node, row] : rows) {
      const int of_block = subdomain.rank_of_block[z(b)], of_node = subdomain.rank_of_node[z(node)];
      if (of_block == subdomain.rank && of_node != subdomain.rank)
        all[static_cast<std::size_t>(of_node)].out.push_back(row);
      if (of_block != subdomain.rank && of_node == subdomain.rank)
        all[static_cast<std::size_t>(of_block)].in.push_back(row);
    }
  }
  // Each rank announces the rows that it will send, so that the others expect them.
  const auto names = [&](const std::vector<Index>& rows) {
    std::vector<Index> named;
    for (const Index r : rows)
      named.insert(named.end(), {subdomain.block[z(blocks.block_of_row[z(r)])], subdomain.node[z(node_of_row[z(r)])]});
    return named;
  };
  std::vector<std::vector<Index>> sent;
  for (const NeighbourRank& border : all)
    sent.push_back(names(border.out));
  sent = exchange_rows(ranks, sent);
  std::vector<NeighbourRank> borders;
  for (std::size_t q = 0; q < all.size(); ++q) {
    all[q].rank = static_cast<int>(q);
    if (names(all[q].in) != sent[q])
      throw std::logic_error("ranks do not agree on the rows that they share");
    if (!all[q].out.empty() || !all[q].in.empty())
      borders.push_back(std::move(all[q]));
  }
  return borders;
}

/// The exchange for one type of row; `Sum` is NodeSum, ProjectedNodeSum or NodePatchRow.  Rows without contributions of particles
/// are not sent.
template <class Sum>
class Halo {
 public:
  Halo() = default;
  /// The exchange of a single rank: all blocks are inner blocks.
  explicit Halo(Index blocks) : inner_(static_cast<std::size_t>(blocks)) { std::iota(inner_.begin(), inner_.end(), 0); }
  template <int D>
  Halo(Communicator& ranks, const Mesh<D>& mesh, const Subdomain& subdomain, const BlockRows<D, Sum>& blocks,
       MessageTag topic = MessageTag::rows)
      : messages_(ranks, topic, find_row_borders(ranks, mesh, subdomain, blocks))
  {
    std::vector<std::uint8_t> outer(static_cast<std::size_t>(blocks.size()), 0);
    for (const NeighbourRank& border : messages_.borders())
      for (const Index r : border.out)
        outer[static_cast<std::size_t>(blocks.block_of_row[static_cast<std::size_t>(r)])] = 1;
    for (Index b = 0; b < blocks.size(); ++b)
      if (subdomain.owns_block(b))
        (outer[static_cast<std::size_t>(b)] != 0 ? outer_ : inner_).push_back(b);
      else
        foreign_.push_back(b);
  }

  /// Own blocks with rows on nodes of other ranks, whose particles use such nodes; the inner blocks have none.
  std::span<const Index> outer_blocks() const noexcept { return outer_; }
  std::span<const Index> inner_blocks() const noexcept { return inner_; }

  /// Sends rows of outer blocks to the owners of their nodes.
  template <class What, int D>
  void send_rows(const BlockRows<D, Sum>& blocks)
  {
    messages_.send(blocks.row, What{});
  }
  /// Receives rows of other ranks on own nodes.
  template <class What, int D>
  void take_rows(BlockRows<D, Sum>& blocks)
  {
    messages_.take(blocks.row, What{});
    for (const Index b : foreign_)
      blocks.occupied[static_cast<std::size_t>(b)] = 1;
  }

 private:
  HaloExchange messages_;
  std::vector<Index> outer_, inner_, foreign_;
};

/// Marks the nodes that particles in own blocks use.
template <int D, class Sum>
std::vector<std::uint8_t> nodes_read(const Subdomain& subdomain, const BlockRows<D, Sum>& blocks)
{
  std::vector<std::uint8_t> read(static_cast<std::size_t>(blocks.rows_of_node.size()), 0);
  for (Index n = 0; n < blocks.rows_of_node.size(); ++n)
    for (const Index r : blocks.rows_of_node[n])
      if (subdomain.owns_block(blocks.block_of_row[static_cast<std::size_t>(r)]))
        read[static_cast<std::size_t>(n)] = 1;
  return read;
}

/// Adds the rows of blocks to sums of the nodes that this rank owns, and of those of other ranks of which it has `copies`; other sums stay
/// empty.  Nodes that are not in use are left out; on_arrival() is called once the rows of other ranks have arrived.
template <class What, int D, class Sum, class OnArrival>
void assemble(BlockRows<D, Sum>& blocks, const OwnNodes& own, Halo<Sum>& halo, HaloExchange& copies, const NodesInUse& in_use,
              SparseRows<Sum>& sum, OnArrival&& on_arrival)
{
  halo.template take_rows<What>(blocks);
  on_arrival();
  const auto add_up = [&](Index n) {
    Sum total = sum[static_cast<std::size_t>(n)];
    What::clear(total);
    if (own.has(n))
      for (const Index r : blocks.rows_of_node[n])
        if (blocks.occupied[static_cast<std::size_t>(blocks.block_of_row[static_cast<std::size_t>(r)])])
          What::add(blocks.row[static_cast<std::size_t>(r)], total);
    sum[static_cast<std::size_t>(n)] = total;
  };
  for (const NeighbourRank& border : copies.borders())
    parallel_for(static_cast<Index>(border.out.size()), [&](Index i) { add_up(border.out[static_cast<std::size_t>(i)]); });
  copies.send(sum, What{});
  in_use.for_each(add_up);  // repeats the few sums above, which is cheaper than to leave them out
  copies.take(sum, What{});
}

/// Calls f(block) for the own blocks, and send_rows() once those are done whose rows other ranks wait for.
template <class Sum, class F, class SendRows>
void for_each_own_block(const Halo<Sum>& halo, F&& f, SendRows&& send_rows)
{
  for (const bool outer : {true, false}) {  // one loop, compiled once
    const std::span<const Index> list = outer ? halo.outer_blocks() : halo.inner_blocks();
    if (!list.empty())
      parallel_for_uneven(static_cast<Index>(list.size()), [&](Index i) { f(list[static_cast<std::size_t>(i)]); });
    if (outer)
      send_rows();
  }
}

/// Calls f(block) for the own blocks; for blocks that use nodes of other ranks after arrive().
template <class Sum, class Arrive, class F>
void for_each_reading_block(const Halo<Sum>& halo, Arrive&& arrive, F&& f)
{
  for (const bool outer : {false, true}) {
    const std::span<const Index> list = outer ? halo.outer_blocks() : halo.inner_blocks();
    if (outer)
      arrive();
    if (!list.empty())
      parallel_for_uneven(static_cast<Index>(list.size()), [&](Index i) { f(list[static_cast<std::size_t>(i)]); });
  }
}

}  // namespace talus
