#pragma once
// Nodes that blocks of several ranks share: rows go to the rank that owns the node, which adds them up in the order of blocks as it would
// alone, and the sums come back to all that read them.
#include <cstring>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "core/exchange.hpp"
#include "mesh/part.hpp"
#include "solver/blocks.hpp"
#include "solver/own_nodes.hpp"

namespace talus {

/// What of a row or sum goes into a message: all of it,
struct Whole {
  template <class Sum>
  static constexpr std::size_t bytes = sizeof(Sum);
  template <class Sum>
  static bool is_there(const Sum& sum) noexcept
  {
    return sum.is_seen();
  }
  template <class Sum>
  static void write(const Sum& sum, std::byte* to) noexcept
  {
    std::memcpy(to, static_cast<const void*>(&sum), sizeof(Sum));
  }
  template <class Sum>
  static void read(const std::byte* from, Sum& sum) noexcept
  {
    std::memcpy(static_cast<void*>(&sum), from, sizeof(Sum));
  }
  template <class Sum>
  static void clear(Sum& sum) noexcept
  {
    sum = Sum{};
  }
  template <class Sum>
  static void add(const Sum& row, Sum& sum) noexcept
  {
    sum += row;
  }
};
/// or momentum alone.
struct MomentumAlone {
  template <class Sum>
  static constexpr std::size_t bytes = Sum::momentum_bytes;
  template <class Sum>
  static bool is_there(const Sum& sum) noexcept
  {
    return sum.has_momentum();
  }
  template <class Sum>
  static void write(const Sum& sum, std::byte* to) noexcept
  {
    sum.write_momentum(to);
  }
  template <class Sum>
  static void read(const std::byte* from, Sum& sum) noexcept
  {
    sum.read_momentum(from);
  }
  template <class Sum>
  static void clear(Sum& sum) noexcept
  {
    sum.clear_momentum();
  }
  template <class Sum>
  static void add(const Sum& row, Sum& sum) noexcept
  {
    sum.add_momentum(row);
  }
};

/// Rows in a message: first which of them are there, a bit each, then those that are.
class Sheet {
 public:
  Sheet(std::size_t rows, std::size_t most_bytes) : rows_(rows), bytes_(head() + rows * most_bytes) {}

  /// Of `items[which[k]]`.
  template <class What, class Sum>
  std::span<std::byte> fill(const std::vector<Index>& which, const std::vector<Sum>& items) noexcept
  {
    std::fill_n(bytes_.begin(), head(), std::byte{0});
    std::byte* to = bytes_.data() + head();
    for (std::size_t k = 0; k < rows_; ++k)
      if (const Sum& item = items[static_cast<std::size_t>(which[k])]; What::is_there(item)) {
        bytes_[k / 8] |= std::byte{1} << (k % 8);
        What::write(item, std::exchange(to, to + What::template bytes<Sum>));
      }
    return {bytes_.data(), to};
  }
  template <class What, class Sum>
  void take(const std::vector<Index>& which, std::vector<Sum>& items) const noexcept
  {
    const std::byte* from = bytes_.data() + head();
    for (std::size_t k = 0; k < rows_; ++k)
      if (Sum& item = items[static_cast<std::size_t>(which[k])]; (bytes_[k / 8] >> (k % 8) & std::byte{1}) != std::byte{0})
        What::read(std::exchange(from, from + What::template bytes<Sum>), item);
      else
        What::clear(item);
  }
  std::span<std::byte> room() noexcept { return bytes_; }

 private:
  std::size_t head() const noexcept { return (rows_ + 63) / 64 * 8; }
  std::size_t rows_;
  std::vector<std::byte> bytes_;
};

/// What goes between this rank and another.
struct Border {
  int rank = 0;
  std::vector<Index> rows_out, rows_in;    ///< of own blocks on its nodes; of its blocks on own nodes: by block and node
  std::vector<Index> nodes_out, nodes_in;  ///< own nodes that it reads; nodes of its that are read here: ascending
};

/// Nodes within `rings` rings of those that `marked` holds.
template <int D>
std::vector<std::uint8_t> spread_by_rings(const Mesh<D>& mesh, std::vector<std::uint8_t> marked, int rings)
{
  for (; rings > 0; --rings) {
    const std::vector<std::uint8_t> before = marked;
    parallel_for(mesh.n_nodes(), [&](Index n) {
      for (const Index m : mesh.ring_of_node()[n])
        marked[static_cast<std::size_t>(n)] |= before[static_cast<std::size_t>(m)];
    });
  }
  return marked;
}

/// Who borders on whom: `read` marks the nodes whose sums are read here, own ones or not.  Every rank has to ask.
template <int D, class Sum>
std::vector<Border> find_borders(Exchange& ranks, const Mesh<D>& mesh, const Share& share, const BlockRows<D, Sum>& blocks,
                                 std::span<const std::uint8_t> read)
{
  const auto z = [](Index i) { return static_cast<std::size_t>(i); };
  std::vector<Index> node_of_row(blocks.row.size());
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    for (const Index r : blocks.rows_of_node[n])
      node_of_row[z(r)] = n;
  std::vector<Border> all(static_cast<std::size_t>(ranks.size()));
  for (Index b = 0; b < blocks.size(); ++b) {
    std::vector<std::pair<Index, Index>> rows;  // node, row
    for (Index r = blocks.begin[z(b)]; r < blocks.begin[z(b) + 1]; ++r)
      rows.emplace_back(node_of_row[z(r)], r);
    std::sort(rows.begin(), rows.end());
    for (const auto& [node, row] : rows) {
      const int of_block = share.rank_of_block[z(b)], of_node = share.rank_of_node[z(node)];
      if (of_block == share.rank && of_node != share.rank)
        all[static_cast<std::size_t>(of_node)].rows_out.push_back(row);
      if (of_block != share.rank && of_node == share.rank)
        all[static_cast<std::size_t>(of_block)].rows_in.push_back(row);
    }
  }
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    if (read[z(n)] != 0 && !share.owns_node(n))
      all[static_cast<std::size_t>(share.rank_of_node[z(n)])].nodes_in.push_back(n);

  // Each rank says what it reads, and what rows it sends: others must expect the same.
  std::vector<std::vector<Index>> wanted(all.size()), sent(all.size());
  for (std::size_t q = 0; q < all.size(); ++q) {
    for (const Index n : all[q].nodes_in)
      wanted[q].push_back(share.node[z(n)]);
    for (const Index r : all[q].rows_out)
      sent[q].insert(sent[q].end(), {share.block[z(blocks.block_of_row[z(r)])], share.node[z(node_of_row[z(r)])]});
  }
  wanted = exchange_rows(ranks, wanted);
  sent = exchange_rows(ranks, sent);
  std::vector<Border> borders;
  for (std::size_t q = 0; q < all.size(); ++q) {
    all[q].rank = static_cast<int>(q);
    for (const Index whole : wanted[q])
      all[q].nodes_out.push_back(share.local_node(whole));
    std::vector<Index> expected;
    for (const Index r : all[q].rows_in)
      expected.insert(expected.end(), {share.block[z(blocks.block_of_row[z(r)])], share.node[z(node_of_row[z(r)])]});
    if (expected != sent[q])
      throw std::logic_error("ranks do not agree on the rows that they share");
    if (!all[q].rows_out.empty() || !all[q].rows_in.empty() || !all[q].nodes_in.empty() || !all[q].nodes_out.empty())
      borders.push_back(std::move(all[q]));
  }
  return borders;
}

/// `Sum` is what blocks keep rows of: NodeSum, HatSum or the rows of StarSums.  Rows that no particle has touched are not sent.
template <class Sum>
class Halo {
 public:
  Halo() = default;
  /// A rank that is alone: all blocks are inner ones.
  explicit Halo(Index blocks) : inner_(static_cast<std::size_t>(blocks)) { std::iota(inner_.begin(), inner_.end(), 0); }
  template <int D>
  Halo(Exchange& ranks, const Mesh<D>& mesh, const Share& share, const BlockRows<D, Sum>& blocks, std::span<const std::uint8_t> read)
      : ranks_(&ranks), borders_(find_borders(ranks, mesh, share, blocks, read)), is_out_(static_cast<std::size_t>(mesh.n_nodes()), 0)
  {
    std::vector<std::uint8_t> outer(static_cast<std::size_t>(blocks.size()), 0);
    for (const Border& border : borders_) {
      for (const Index r : border.rows_out)
        outer[static_cast<std::size_t>(blocks.block_of_row[static_cast<std::size_t>(r)])] = 1;
      for (const Index n : border.nodes_out)
        if (std::exchange(is_out_[static_cast<std::size_t>(n)], 1) == 0)
          nodes_out_.push_back(n);
    }
    for (Index b = 0; b < blocks.size(); ++b)
      if (share.owns_block(b))
        (outer[static_cast<std::size_t>(b)] != 0 ? outer_ : inner_).push_back(b);
      else
        foreign_.push_back(b);
    const auto prepare = [&](auto member, std::vector<Sheet>& sheets) {
      for (const Border& border : borders_)
        sheets.emplace_back((border.*member).size(), sizeof(Sum));
    };
    prepare(&Border::rows_out, rows_out_), prepare(&Border::rows_in, rows_in_);
    prepare(&Border::nodes_out, sums_out_), prepare(&Border::nodes_in, sums_in_);
  }

  /// Own blocks with rows for others, to be done first, and those without.
  std::span<const Index> outer_blocks() const noexcept { return outer_; }
  std::span<const Index> inner_blocks() const noexcept { return inner_; }
  /// Own nodes that others read, to be summed first.
  std::span<const Index> nodes_out() const noexcept { return nodes_out_; }
  bool is_out(Index node) const noexcept { return !is_out_.empty() && is_out_[static_cast<std::size_t>(node)] != 0; }

  /// Sends rows of outer blocks to the owners of their nodes.
  template <class What, int D>
  void send_rows(const BlockRows<D, Sum>& blocks)
  {
    start<What>(&Border::rows_out, &Border::rows_in, blocks.row, rows_out_, rows_in_, Tag::rows);
  }
  /// Rows of others on own nodes, into their places here.
  template <class What, int D>
  void take_rows(BlockRows<D, Sum>& blocks)
  {
    finish<What>(&Border::rows_in, rows_in_, blocks.row);
    for (const Index b : foreign_)
      blocks.occupied[static_cast<std::size_t>(b)] = 1;
  }
  /// Sends sums of own nodes to those who read them.
  template <class What>
  void send_sums(const std::vector<Sum>& sum)
  {
    start<What>(&Border::nodes_out, &Border::nodes_in, sum, sums_out_, sums_in_, Tag::sums);
  }
  template <class What>
  void take_sums(std::vector<Sum>& sum)
  {
    finish<What>(&Border::nodes_in, sums_in_, sum);
  }

 private:
  using List = std::vector<Index> Border::*;
  enum class Tag : int { rows = 1, sums = 2 };

  template <class What>
  void start(List out, List in, const std::vector<Sum>& items, std::vector<Sheet>& sheets_out, std::vector<Sheet>& sheets_in, Tag tag)
  {
    if (borders_.empty())
      return;
    letters_out_.clear(), letters_in_.clear();
    for (std::size_t q = 0; q < borders_.size(); ++q) {
      if (!(borders_[q].*in).empty())
        letters_in_.push_back({borders_[q].rank, sheets_in[q].room(), true});
      if (!(borders_[q].*out).empty())
        letters_out_.push_back({borders_[q].rank, sheets_out[q].template fill<What>(borders_[q].*out, items)});
    }
    ranks_->start(letters_out_, letters_in_, static_cast<int>(tag), talk_);
  }
  template <class What>
  void finish(List in, const std::vector<Sheet>& sheets, std::vector<Sum>& items)
  {
    if (borders_.empty())
      return;
    talk_.wait();
    for (std::size_t q = 0; q < borders_.size(); ++q)
      if (!(borders_[q].*in).empty())
        sheets[q].template take<What>(borders_[q].*in, items);
  }

  Exchange* ranks_ = nullptr;
  std::vector<Border> borders_;
  std::vector<Index> outer_, inner_, foreign_, nodes_out_;
  std::vector<std::uint8_t> is_out_;
  std::vector<Sheet> rows_out_, rows_in_, sums_out_, sums_in_;  // by border
  std::vector<Parcel> letters_out_, letters_in_;
  Talk talk_;
};

/// Of rows on the stencils of cells: what particles in own cells read, and what others within `rings` rings of it need to know.
template <int D, class Sum>
Halo<Sum> make_halo(Exchange& ranks, const Mesh<D>& mesh, const Share& share, const BlockRows<D, Sum>& blocks, int rings)
{
  if (share.alone())
    return Halo<Sum>(blocks.size());
  std::vector<std::uint8_t> read(static_cast<std::size_t>(mesh.n_nodes()), 0);
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    for (const Index r : blocks.rows_of_node[n])
      if (share.owns_block(blocks.block_of_row[static_cast<std::size_t>(r)]))
        read[static_cast<std::size_t>(n)] = 1;
  return Halo<Sum>(ranks, mesh, share, blocks, spread_by_rings(mesh, std::move(read), rings));
}

/// Rows of blocks -> sums of the nodes that this rank owns, or reads; those of other nodes stay empty.
template <class What, int D, class Sum>
void assemble(BlockRows<D, Sum>& blocks, const OwnNodes& own, Halo<Sum>& halo, std::vector<Sum>& sum)
{
  halo.template take_rows<What>(blocks);
  const auto add_up = [&](Index n) {
    Sum total = sum[static_cast<std::size_t>(n)];
    What::clear(total);
    if (own.has(n))
      for (const Index r : blocks.rows_of_node[n])
        if (blocks.occupied[static_cast<std::size_t>(blocks.block_of_row[static_cast<std::size_t>(r)])])
          What::add(blocks.row[static_cast<std::size_t>(r)], total);
    sum[static_cast<std::size_t>(n)] = total;
  };
  const std::span<const Index> first = halo.nodes_out();
  parallel_for(static_cast<Index>(first.size()), [&](Index i) { add_up(first[static_cast<std::size_t>(i)]); });
  halo.template send_sums<What>(sum);
  parallel_for(static_cast<Index>(sum.size()), [&](Index n) {
    if (!halo.is_out(n))
      add_up(n);
  });
  halo.template take_sums<What>(sum);
}

/// f(block) for the own blocks, and their rows sent on their way.
template <class What, int D, class Sum, class F>
void for_each_own_block(BlockRows<D, Sum>& blocks, Halo<Sum>& halo, F&& f)
{
  for (const bool outer : {true, false}) {  // one loop, compiled once
    const std::span<const Index> list = outer ? halo.outer_blocks() : halo.inner_blocks();
    if (!list.empty())
      parallel_for_uneven(static_cast<Index>(list.size()), [&](Index i) { f(list[static_cast<std::size_t>(i)]); });
    if (outer)
      halo.template send_rows<What>(blocks);
  }
}

}  // namespace talus
