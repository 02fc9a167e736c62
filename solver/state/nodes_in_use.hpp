#pragma once
// The nodes that a step visits: those near particles.
#include <algorithm>
#include <span>
#include <vector>

#include "core/parallel/threads.hpp"
#include "mesh/mesh.hpp"
#include "solver/state/owned_nodes.hpp"

namespace talus {

/// Nodes of a mesh in chunks of consecutive numbers.  A chunk is in use while it has nodes within two rings of the cells of a block that holds
/// particles: further no kernel and no host of a node of small mass reaches.  It is visited once more when they have left, so that its
/// nodes get the values of nodes without particles.
class NodesInUse {
 public:
  /// All nodes are in use until find() is called.
  explicit NodesInUse(Index n_nodes) : n_nodes_(n_nodes), users_(static_cast<std::size_t>((n_nodes + chunk - 1) / chunk), 0)
  {
    for (Index c = 0; c < static_cast<Index>(users_.size()); ++c)
      visited_.push_back(c);
  }

  /// Makes the tables for find().
  template <int D>
  void prepare(const Mesh<D>& mesh, const OwnNodes& own)
  {
    own_blocks_ = own.of_block;
    const Index n_blocks = blocks_of(mesh.n_cells());
    occupied_.assign(static_cast<std::size_t>(n_blocks), 0);
    chunks_of_block_.begin.assign(1, 0);
    std::vector<Index> seen(static_cast<std::size_t>(n_nodes_), none), seen_chunk(users_.size(), none), front, next;
    for (Index b = 0; b < n_blocks; ++b) {
      const auto reach = [&](Index n) {
        if (std::exchange(seen[static_cast<std::size_t>(n)], b) == b)
          return;
        next.push_back(n);
        if (std::exchange(seen_chunk[static_cast<std::size_t>(n / chunk)], b) != b)
          chunks_of_block_.item.push_back(n / chunk);
      };
      next.clear();
      for (Index c = b * block_cells; c < std::min(mesh.n_cells(), (b + 1) * block_cells); ++c)
        std::ranges::for_each(mesh.cell(c), reach);
      for (int ring = 0; ring < rings; ++ring) {
        front.swap(next);
        next.clear();
        for (const Index n : front)
          std::ranges::for_each(mesh.ring_of_node()[n], reach);
      }
      chunks_of_block_.begin.push_back(static_cast<Index>(chunks_of_block_.item.size()));
    }
  }

  /// `occupied`: whether each block holds particles now.  With `everything` all nodes are in use whatever it says.
  void find(std::span<const std::uint8_t> occupied, bool everything)
  {
    bool changed = !left_.empty() || everything != everything_ || !found_;
    found_ = true;
    left_.clear();
    if (everything_ && !everything)
      left_ = visited_;
    everything_ = everything;
    for (std::size_t b = 0; b < occupied_.size(); ++b) {
      const int change = (occupied[b] != 0 ? 1 : 0) - occupied_[b];
      if (change == 0)
        continue;
      changed = true;
      occupied_[b] = static_cast<std::uint8_t>(occupied_[b] + change);
      for (const Index c : chunks_of_block_[static_cast<Index>(b)])
        if ((users_[static_cast<std::size_t>(c)] += change) == 0)
          left_.push_back(c);
    }
    if (changed)
      list();
  }

  /// The number of nodes in use, rounded up to whole chunks.
  Index size() const noexcept { return std::min(n_nodes_, static_cast<Index>(visited_.size()) * chunk); }
  /// Calls f(node) for all nodes in use, in parallel; f must not write data that another node reads.
  template <class F>
  void for_each(F&& f) const
  {
    parallel_for(static_cast<Index>(visited_.size()), [&](Index i) { visit(visited_[static_cast<std::size_t>(i)], f); });
  }
  /// The same one after the other, ascending.
  template <class F>
  void for_each_ascending(F&& f) const
  {
    for (const Index c : visited_)
      visit(c, f);
  }
  /// The ranges of nodes first used by own blocks, as far as they are in use, for sums.
  std::span<const IndexRange> own() const noexcept { return own_; }

 private:
  static constexpr Index chunk = 64;
  static constexpr int rings = 2;

  template <class F>
  void visit(Index c, F& f) const
  {
    for (Index n = c * chunk; n < std::min(n_nodes_, (c + 1) * chunk); ++n)
      f(n);
  }

  void list()
  {
    visited_.clear();
    std::ranges::sort(left_);
    for (Index c = 0; c < static_cast<Index>(users_.size()); ++c)
      if (everything_ || users_[static_cast<std::size_t>(c)] > 0 || std::ranges::binary_search(left_, c))
        visited_.push_back(c);
    own_.clear();
    for (const IndexRange& range : own_blocks_) {
      const auto first = std::ranges::lower_bound(visited_, range.begin / chunk);
      if (first != visited_.end() && *first <= (range.end - 1) / chunk)
        own_.push_back(range);
    }
  }

  Index n_nodes_;
  Csr chunks_of_block_;
  std::vector<std::uint8_t> occupied_;
  std::vector<int> users_;      ///< by chunk: number of blocks with particles that reach it
  std::vector<Index> left_;     ///< chunks that lost the last of them now
  std::vector<Index> visited_;  ///< chunks in use, ascending
  std::vector<IndexRange> own_blocks_, own_;
  bool found_ = false, everything_ = false;
};

}  // namespace talus
